"""Back into the simulator that people run: exporters, replay in other engines, and what each format has a place for.

`corrected_arm` is the model as an arm that a simulator can have; `export` writes it through one of `exporters`,
`replay` runs recordings in one of `engines`, `round_trips` measures how far an export moves an engine off the model.
"""
