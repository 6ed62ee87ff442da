"""Named tolerances, each with its reason; tests take theirs from here."""

IDENTITY = 1e-9  # physics identities in float64: rounding of ~1e3 operations on numbers of order 1 to 1e3
ORACLE = 1e-8  # against Pinocchio in float64: two algorithms, same physics
AUTODIFF = 1e-5  # against central finite differences at step 1e-6: truncation plus rounding
RECOVERY = 1e-6  # parameters from noise-free data made by the same law
STATISTICAL = 4.0  # standard errors: a false alarm in 16 000 draws
