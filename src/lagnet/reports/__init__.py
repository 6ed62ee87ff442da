"""What a person reads: self-contained HTML pages of a diagnosis, a decomposition or a check.

`page` binds sections to one file, `figures` says what a plot is, `wording` how numbers are put; a `…_report` module
holds the sections of one kind of page.
"""
