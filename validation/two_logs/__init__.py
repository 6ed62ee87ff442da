"""Does a log of the simulator do in the place of its model? The same plants, diagnosed by both routes."""
