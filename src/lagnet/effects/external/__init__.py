"""Forces from outside, on an interval of time."""
