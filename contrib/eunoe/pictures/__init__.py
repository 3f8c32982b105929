"""The commands that make the documentation's pictures, and the record of what made each picture."""
