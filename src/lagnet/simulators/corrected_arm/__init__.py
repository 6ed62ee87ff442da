"""A corrected model as an arm that a simulator can have: its physics as numbers, its drive, and how it moves."""
