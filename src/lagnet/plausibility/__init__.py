"""Can this be the dynamics of a real arm? Checks of any model with the calls of InverseDynamics, and a pytest plugin.

`suite.check` runs all of `checks.CHECKS`; each is one file in `checks/`, and what several of them ask of a model is in
`quantities/`. The worst configuration is found by sampling and by a local search (`search`). `pytest_plugin` runs the
same checks as tests.
"""
