#!/usr/bin/python3
"""Motion of a half-submerged disc that is let go off its draft, or that waves move, by linear theory: prints the numbers that
the studies heave-decay and buoy-in-waves refer to, and fails if these files have others.

Units of the disc's radius, gravity and the water's density. Added mass A and damping B of a heaving disc come from
Ursell's (1949) source and wave-free multipoles, the motion from
    (M + A_inf) x'' + int_0^t K(t - s) x'(s) ds + 2 x = 0,   K(t) = 2/pi int_0^inf B(w) cos(w t) dw,
as Maskell and Ursell (1970) posed it, in boundless water; in the closed tank of the study, whose walls make a difference of 2 to 14 %,
by boundary elements. Waves of amplitude a push with a sqrt(B/w), by Haskind's relation. usage: heave_theory.py HEAVE-DECAY.xml
BUOY-IN-WAVES.xml
"""
import re
import sys

import numpy as np
from scipy.special import exp1

MASS = ADDED_MASS_AT_ONCE = np.pi / 2
STIFFNESS = 2.0


def added_mass_and_damping(frequency, n_multipoles=24, n_points=96):
    """By least squares over points of the disc; theta is measured from below."""
    k = frequency**2
    theta = (np.arange(n_points) + 0.5) / n_points * np.pi / 2
    z = np.exp(-1j * theta)
    standing = np.exp(-k * z) * (exp1(-k * z) + 1j * np.pi)  # its real part is the principal value
    wave = np.exp(-k * z)
    potentials = [standing.real + 1j * np.pi * wave.real]
    slopes = [((-k * standing - 1 / z) * z).real + 1j * np.pi * (-k * wave * z).real]
    for m in range(1, n_multipoles):
        even, odd = np.cos(2 * m * theta), np.cos((2 * m - 1) * theta)
        potentials.append(even + k / (2 * m - 1) * odd + 0j)
        slopes.append(-2 * m * even - k * odd + 0j)
    matrix = np.array(slopes).T
    sizes = np.abs(matrix).max(axis=0)
    strengths = np.linalg.lstsq(matrix / sizes, np.cos(theta) + 0j, rcond=None)[0] / sizes
    pressure = 1j * frequency * (np.array(potentials).T @ strengths)
    force = -2 * np.sum(pressure * np.cos(theta)) * (np.pi / 2 / n_points)
    return force.imag / frequency, -force.real


def response(frequency):
    """Amplitude of the heave over that of the waves."""
    added, damping = added_mass_and_damping(frequency)
    return np.sqrt(damping / frequency) / abs(STIFFNESS - frequency**2 * (MASS + added) + 1j * frequency * damping)


def swing(end=9.0, dt=0.01):
    """Times and heights; trapezoidal rules."""
    frequencies = np.linspace(0, 9, 600)
    damping = np.array([0] + [added_mass_and_damping(w)[1] for w in frequencies[1:]])
    times = np.arange(0, end + dt / 2, dt)
    memory = 2 / np.pi * np.trapz(damping * np.cos(np.outer(times, frequencies)), frequencies, axis=1)
    x, v = np.zeros_like(times), np.zeros_like(times)
    x[0] = 1
    inertia = (MASS + ADDED_MASS_AT_ONCE) / dt
    remembered = 0.0
    for i in range(1, len(times)):
        known = dt * (memory[i:0:-1] @ v[:i])  # v[0] = 0
        now = 0.5 * dt * memory[0]
        right = inertia * v[i - 1] - (remembered + known) / 2 - STIFFNESS * (x[i - 1] + dt / 4 * v[i - 1])
        v[i] = right / (inertia + now / 2 + STIFFNESS * dt / 4)
        x[i] = x[i - 1] + dt / 2 * (v[i - 1] + v[i])
        remembered = known + now * v[i]
    return times, x


def graded(begin, end, first, growth, largest):
    """Places from begin to end, at distances that grow from `first`."""
    steps = [first]
    while sum(steps) < abs(end - begin):
        steps.append(min(growth * steps[-1], largest))
    return begin + (end - begin) * np.concatenate([[0], np.cumsum(steps)]) / sum(steps)


def panels(half_width, depth, n_arc=64):
    """The boundary of the right half of the water, once round with the water on the left: begins and ends of straight panels, and which
    of them are on the surface and on the disc."""
    angle = np.linspace(np.pi / 2, 0, n_arc + 1)
    size = np.pi / 2 / n_arc
    bottom = graded(0, half_width, .5, 1.1, 1.)
    wall = graded(0, -depth, .2, 1.1, .8)[::-1]
    surface = graded(1, half_width, size / 2, 1.05, .3)[::-1]
    axis = graded(-1, -depth, size, 1.1, .8)
    lines = [(bottom, -depth + 0 * bottom), (half_width + 0 * wall, wall), (surface, 0 * surface), (np.sin(angle), -np.cos(angle)), (0 * axis, axis)]
    lines = [np.array(line).T for line in lines]
    part = np.repeat(range(len(lines)), [len(line) - 1 for line in lines])
    return np.vstack([line[:-1] for line in lines]), np.vstack([line[1:] for line in lines]), part == 2, part == 3


def influence(begin, end):
    """Green's third identity at the middles of panels with constant values, H potential = G slope; slopes are along the normals that
    leave the water, which are returned, too."""
    length = np.hypot(*(end - begin).T)
    along = (end - begin) / length[:, None]
    normal = np.array([along[:, 1], -along[:, 0]]).T
    way = (begin + end)[:, None] / 2 - begin[None]
    s, d = (way * along).sum(2), (way * normal).sum(2)
    np.fill_diagonal(d, 0)
    straight = np.abs(d) < 1e-12
    arc = lambda x: np.where(straight, 0, np.arctan(x / np.where(straight, 1, d)))  # noqa: E731
    logarithm = lambda x: x / 2 * np.log(x ** 2 + d ** 2) - x + d * arc(x)  # noqa: E731
    slope = -(logarithm(length - s) - logarithm(-s)) / (2 * np.pi)
    potential = (arc(length - s) + arc(s)) / (2 * np.pi) + np.eye(len(length)) / 2
    return potential, slope, length, normal


def swing_in_tank(half_width, depth, end=9.0, dt=0.01):
    """Times and heights in a closed tank, by boundary elements and Runge and Kutta's method; shares nothing with `swing`. On the surface
    the potential's rate is -eta, and eta's its slope; the force on the disc is that of the pressure -d potential/dt."""
    begins, ends, surface, disc = panels(half_width, depth)
    potential, slope, length, normal = influence(begins, ends)
    known = np.column_stack([-potential[:, surface], slope[:, disc] @ normal[disc, 1]])  # by potentials at the surface and x'
    unknown = np.linalg.solve(np.where(surface, -slope, potential), known)
    rise, rise_by_disc = unknown[surface][:, :-1], unknown[surface][:, -1]
    push = 2 * (length[disc] * normal[disc, 1]) @ unknown[disc]  # both halves of the disc
    inertia, n = MASS + push[-1], surface.sum()

    def rates(state):
        eta, x, v = state[n:2 * n], state[-2], state[-1]
        return np.concatenate([-eta, rise @ state[:n] + rise_by_disc * v, [v, (push[:-1] @ eta - STIFFNESS * x) / inertia]])

    state = np.zeros(2 * n + 2)
    state[-2] = 1
    heights = [1.]
    for _ in range(round(end / dt)):
        first = rates(state)
        second = rates(state + dt / 2 * first)
        third = rates(state + dt / 2 * second)
        state = state + dt / 6 * (first + 2 * second + 2 * third + rates(state + dt * third))
        heights.append(state[-2])
    return dt * np.arange(len(heights)), np.array(heights)


def numbers_of(times, x):
    return {"first trough": x.min(), "first crest": x[times > 4].max(), "height at 5 sqrt(R/g)": np.interp(5, times, x)}


def main():
    # Limits of A: logarithmic at low frequencies, pi/2 at high ones.
    assert abs(added_mass_and_damping(9.0)[0] - ADDED_MASS_AT_ONCE) < 0.01
    # Two theories that share nothing agree where the tank is wide.
    boundless, wide = numbers_of(*swing()), numbers_of(*swing_in_tank(120, 90))
    for name, number in boundless.items():
        print(f"{name}: {number:.5f} in boundless water, {wide[name]:.5f} in a wide tank")
        assert abs(wide[name] / number - 1) < .01
    text = open(sys.argv[1]).read()
    wrong = False
    for name, number in numbers_of(*swing_in_tank(18, 16)).items():
        reference = re.search(f'name="{re.escape(name)}">.*?name="Reference" type="string" value="([^"]*)"', text, re.S).group(1)
        stated = float(reference)
        print(f"{name}: {number:.5f} in the study's tank; the study has {stated:.5f}")
        wrong = wrong or abs(stated / number - 1) > 0.001
    # Long waves carry the disc along.
    assert abs(response(0.05) - 1) < .01
    text = open(sys.argv[2]).read()
    stated = re.findall(r'name="response" type="double" value="([^"]*)"', text)
    for frequency, number in zip(map(float, re.findall(r'ParameterList name="w = ([0-9.]*)"', text)), map(float, stated)):
        print(f"w = {frequency}: {response(frequency):.4f}; the study has {number}")
        wrong = wrong or abs(number / response(frequency) - 1) > 0.001
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
