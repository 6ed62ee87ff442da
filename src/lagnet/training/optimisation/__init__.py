"""Gradient steps on the torque error: the loss, SOAP, the compiled loop, and one training from start to end."""
