"""Long runs: kills and restarts, memory over millions of steps."""
