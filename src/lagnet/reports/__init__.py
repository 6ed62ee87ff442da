"""What a person reads: self-contained HTML pages of a diagnosis, a decomposition or a check.

`contents` is what a page is made from, `sections` its parts, `figures` its plots; `wording` says how numbers are put,
`page` binds sections to one file; a `…_report` module holds the sections of one kind of page.
"""
