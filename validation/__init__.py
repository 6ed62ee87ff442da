"""Numbered studies of what lagnet claims; not part of the package."""
