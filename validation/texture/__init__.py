"""Concealed plants whose torque carries what real arms leave unexplained."""
