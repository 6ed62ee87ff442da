"""Back into the simulator that people run: exporters, replay in other engines, and what each format has a place for."""
