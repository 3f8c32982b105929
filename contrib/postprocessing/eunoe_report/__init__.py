"""The parts of report.py: readers of a run's output folder, figures, and the page."""
