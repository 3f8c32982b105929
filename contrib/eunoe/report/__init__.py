"""Pages about runs and studies, with their figures."""
