"""What is wrong with the data of a recording, looked for before any physics is: one check a file in `checks/`."""
