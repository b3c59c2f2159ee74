"""Random small cases and their twins: the same problem written in another way. See scripts/random_twins.py."""
