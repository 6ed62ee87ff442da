"""A serial arm with everything about it unknown: joint axes, link lengths, gravity and inertias, all found from torque.

Read in this order: `kinematics` (where the frames are and how they accelerate), `newton_euler` (torque from inertias),
`lifting` (the relaxation that leaves only axis directions nonlinear), `separable` (variable projection with
Levenberg–Marquardt), `search` (from random starts to an arm), `consistency` (physical inertias), `fit` (all of it) and
`model` (the NumPy side, saved and loaded).
"""
