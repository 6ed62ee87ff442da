"""What changed, when, and whether it is more than temperature and load explain."""
