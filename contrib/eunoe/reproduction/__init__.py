"""The campaign of spreading runs that reproduces Gaboriault et al. (2025), its small results and its page."""
