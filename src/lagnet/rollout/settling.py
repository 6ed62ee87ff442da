"""Speeds of all joints at the end of a step, with the dry frictions that go with them: v' of A v' = n − h F sign(v').

It is the minimum of ½ v'ᵀ A v' − nᵀ v' + h Σ Fᵢ |v'ᵢ|. Once it is known which joints rest and to which side the others
move, v' follows from one linear equation. A sweep of projected Gauss–Seidel guesses that, the equation is solved, and
the next sweep, which then moves nothing, shows that the guess was right; else it makes a better one. Sweeps alone
converge slowly where rotors are small beside the coupling of the bodies. What a yielding transmission joins is linear
as well, until it touches or lets go; where an impact has no solution the last sweep stands.
Sources: Moreau 1988; Stewart & Trinkle 1996.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lagnet.rollout.surface import pressed
from lagnet.rollout.transmission import joined_speeds
from lagnet.servos.friction import dry_friction, falls_with_speed

SWEEPS = 50  # at most; two suffice where the first guess is right
SOLUTIONS = 8  # of linear equations at most
NEAR = 1e-6  # of a push, over which the speed behind a yielding transmission is a line
STILL = 1e-12  # [rad/s] change of a sweep below which it has converged


@njit(cache=True, error_model="numpy")
def settle(parameters, a, free, load, motor, push, h, v, motors, contact, work):  # pragma: no cover - compiled
    """Speeds at the end of a step, written into v; push: torques at rest.

    motors: of yielding transmissions, with their speeds and sides of contact, written in place; contact: see `pressed`;
    work: of `settling_space`.
    """
    old, before, dry, lines, equation, sides, solved = work
    for j in range(v.size):
        old[j], before[j], solved[j] = v[j], motors[3][j], np.nan
        for side in range(2):
            dry[j, side] = h * dry_friction(parameters[j], v[j], load[j], motor[j], 2.0 * side - 1.0)
    for n in range(SWEEPS):
        if _sweep(parameters, a, free, load, motor, push, h, v, motors, contact, (old, before, dry, lines)) < STILL:
            break
        if n < SOLUTIONS:
            _solve(a, free, dry, h, v, motors[0], contact, (lines, equation, sides, solved))


def settling_space(dof: int) -> tuple[np.ndarray, ...]:
    """Arrays that `settle` writes in, made once for a rollout."""
    speeds = np.empty(dof), np.empty(dof)
    equation = np.empty((dof, dof + 1))
    return *speeds, np.empty((dof, 2)), np.zeros((dof, 2)), equation, np.empty(dof + 1), np.empty(dof + 1)


@njit(cache=True, error_model="numpy")
def _sweep(parameters, a, free, load, motor, push, h, v, motors, contact, begun):  # pragma: no cover - compiled
    """The speed of one joint after the other, the others held; the greatest change."""
    apart, rows, twist, w, sides = motors
    old, before, dry, lines = begun
    moved = 0.0
    for j in range(v.size):
        rest, alone = free[j], h * push[j]
        for m in range(v.size):
            if m != j:
                rest -= a[j, m] * v[m]
                alone -= a[j, m] * (v[m] - old[m])
        if apart[j]:
            own = (rows[j, 0], rows[j, 1], rows[j, 2], rows[j, 3])
            given = (twist[j], before[j], old[j], load[j], motor[j])
            ahead = rest + NEAR * (abs(rest) + NEAR)
            _, beyond, _ = joined_speeds(parameters[j], own, a[j, j], ahead, *given, h)
            w[j], new, sides[j] = joined_speeds(parameters[j], own, a[j, j], rest, *given, h)
            lines[j, 0] = (beyond - new) / (ahead - rest)
            lines[j, 1] = new - lines[j, 0] * rest
        else:
            new, side, alone = _rigid((dry[j, 0], dry[j, 1]), rest, alone, a[j, j], v, j, contact, h)
            passes = falls_with_speed(parameters[j]) and old[j] * new < 0.0
            if passes and abs(alone) <= h * dry_friction(parameters[j], 0.0, load[j], motor[j], side):
                new = 0.0  # it rests between
        moved = max(moved, abs(new - v[j]))
        v[j] = new
    return moved


@njit(cache=True, error_model="numpy")
def _rigid(dry, rest, alone, inertia, v, j, contact, h):  # pragma: no cover - compiled
    """Speed of a joint without a motor apart, the side it is pushed to, and its push at rest with that of a surface."""
    new, side = _slowed(dry, rest, inertia)
    heavier, pushed = pressed(contact, v, j, new, h)
    if heavier > 0.0:
        new, side = _slowed(dry, rest + pushed, inertia + heavier)
        alone += pushed if pushed * contact[0][j] > 0.0 else 0.0
    return new, side, alone


@njit(cache=True, error_model="numpy")
def _slowed(dry, rest, inertia):  # pragma: no cover - compiled
    """Speed of a joint that `rest` would push to rest / inertia, with its dry friction; the side it is pushed to."""
    side, most = (1.0, dry[1]) if rest > 0.0 else (-1.0, dry[0])
    return (0.0 if abs(rest) <= most else (rest - side * most) / inertia), side


@njit(cache=True, error_model="numpy")
def _solve(a, free, dry, h, v, apart, contact, work):  # pragma: no cover - compiled
    """The least energy of the joints that move, to the sides that v has them move to; one that comes to rest stays.

    On the way to the solution of their linear equation v stops where the first of them rests, and goes on without it.
    A link behind a yielding transmission moves on the line that its speed follows near its push of now.
    The last side is a surface's: the impulse per way [N s/m] where v ends below it.
    """
    lines, equation, sides, solved = work
    slopes, below, hardness = contact
    for j in range(v.size):
        sides[j] = 1.0 if v[j] > 0.0 else (-1.0 if v[j] < 0.0 else 0.0)
        if apart[j]:
            sides[j] = 0.0
        below += 0.5 * h * slopes[j] * v[j]
    sides[v.size] = h * hardness if below < 0.0 else 0.0
    same = True
    for j in range(v.size + 1):
        same = same and sides[j] == solved[j] and not (j < v.size and apart[j])
        solved[j] = sides[j]
    for _ in range(0 if same else v.size):
        _write(equation, a, free, dry, h, sides, contact)
        for j in range(v.size):
            if apart[j]:  # v'_j = slope · push + speed without it
                for m in range(v.size):
                    equation[j, m] = lines[j, 0] * a[j, m] if m != j else 1.0
                equation[j, v.size] = lines[j, 1] + lines[j, 0] * free[j]
        _eliminate(equation)
        way, first = 1.0, -1
        for j in range(v.size):
            x = equation[j, v.size]
            if x * sides[j] < 0.0 and v[j] / (v[j] - x) < way:
                way, first = v[j] / (v[j] - x), j
        for j in range(v.size):
            v[j] += way * (equation[j, v.size] - v[j])
        if first < 0:
            break
        v[first] = sides[first] = 0.0


@njit(cache=True, error_model="numpy")
def _write(equation, a, free, dry, h, sides, contact):  # pragma: no cover - compiled
    """The linear equation of the joints that move, v' = 0 for the others; a surface pushes as the last side says."""
    slopes, height, _ = contact
    dof, stiff = free.size, sides[free.size]
    for j in range(dof):
        moves = sides[j] != 0.0
        for m in range(dof):
            equation[j, m] = a[j, m] + 0.5 * h * stiff * slopes[j] * slopes[m] if moves else 0.0
        equation[j, dof] = 0.0
        if moves:
            equation[j, dof] = free[j] - stiff * slopes[j] * height - sides[j] * dry[j, 1 if sides[j] > 0.0 else 0]
        else:
            equation[j, j] = 1.0


@njit(cache=True, error_model="numpy")
def _eliminate(equation):  # pragma: no cover - compiled
    """x of M x = b into the last column of (M b): M is positive definite but for positive factors of its rows."""
    n = equation.shape[0]
    for k in range(n):
        for i in range(k + 1, n):
            factor = equation[i, k] / equation[k, k]
            if factor != 0.0:
                for m in range(k + 1, n + 1):
                    equation[i, m] -= factor * equation[k, m]
    for k in range(n - 1, -1, -1):
        for m in range(k + 1, n):
            equation[k, n] -= equation[k, m] * equation[m, n]
        equation[k, n] /= equation[k, k]
