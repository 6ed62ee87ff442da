"""A level surface that the arm touches, such as the table it stands on."""
