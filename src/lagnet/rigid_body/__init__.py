"""What the simulator believes: rigid bodies from URDF, MJCF or a robot's name, through Pinocchio.

The only room that imports Pinocchio. `robot` holds the calls, `descriptions` reads and writes files, `inertia` knows
which ten numbers can be a body, `base_parameters` which of them a motion can show.
"""
