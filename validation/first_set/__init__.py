"""Study, see README.md."""
