"""One simulator or format a file."""
