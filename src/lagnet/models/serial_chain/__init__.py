"""A serial arm with everything about it unknown: joint axes, link lengths, gravity and inertias, all found from torque.

Read in this order. Of `mechanics`: `kinematics` (where the frames are and how they accelerate) and `newton_euler`
(torque from inertias). Of `identification`: `lifting` (the relaxation that leaves only axis directions nonlinear),
`separable` (variable projection with Levenberg–Marquardt), `search` (from random starts to an arm), `refit` (all
unknowns at once; inertias that can exist) and `fit` (all of it). Then `model` (the NumPy side, saved and loaded).
"""
