"""The sections of the diagnosis report, one a file; each has `build(findings)` and a template of its name."""
