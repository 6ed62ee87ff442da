"""One worker against two, memory of each, and what the scheduler costs. See README.md."""
