"""What a servo-driven joint may have that its nominal servo has not, one cause a file."""
