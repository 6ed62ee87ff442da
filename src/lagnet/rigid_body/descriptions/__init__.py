"""Robot descriptions: URDF and MJCF read from files that nobody vouches for, robots by name, and files written back.

`reading` finds what is asked for, `description` is what it gives. `xml_files` bounds what is read; `urdf` and `mjcf`
build the model after their `…_checks`; `mass_checks` says which masses no arm has; `writing` turns a model back into
URDF or MJCF.
"""
