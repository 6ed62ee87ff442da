"""How far an export moves an engine off the corrected model: cases, a controller, and the two motions compared."""
