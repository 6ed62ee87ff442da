"""Memory and time in which a large bag is read."""
