"""A chain of three free boxes with two hinges, by its equations of motion: positions with Lagrange multipliers for the
accelerations, and steps so small that they are exact."""
import numpy as np

LENGTH, WIDTH = 1., .2
SPINS = (1.5, -1., 2.)
MASSES = np.diag([1., 1., (LENGTH ** 2 + WIDTH ** 2) / 12] * 3)
INVERSE = np.linalg.inv(MASSES)


def arms(turns):
    """Returns for each hinge a body and its arm, and the next body and its arm."""
    half = [np.array([np.cos(a), np.sin(a)]) * LENGTH / 2 for a in turns]
    return [(0, half[0], 1, -half[1]), (1, half[1], 2, -half[2])]


def rows(turns):
    result = np.zeros((4, 9))
    for k, (i, arm, j, other) in enumerate(arms(turns)):
        two = result[2 * k:2 * k + 2]
        two[:, 3 * i:3 * i + 2], two[:, 3 * j:3 * j + 2] = -np.eye(2), np.eye(2)
        two[:, 3 * i + 2], two[:, 3 * j + 2] = (arm[1], -arm[0]), (-other[1], other[0])
    return result


def acceleration(x, v):
    w, hold = v[2::3], rows(x[2::3])
    pull = np.concatenate([arm * w[i] ** 2 - other * w[j] ** 2 for i, arm, j, other in arms(x[2::3])])
    return INVERSE @ hold.T @ np.linalg.solve(hold @ INVERSE @ hold.T, -pull)


def start():
    """After the impact of joints on spins that they do not let."""
    x, v = np.array([-1., 0, 0, 0, 0, 0, 1, 0, 0]), np.array([0, 0, SPINS[0], 0, 0, SPINS[1], 0, 0, SPINS[2]])
    hold = rows(x[2::3])
    return x, v - INVERSE @ hold.T @ np.linalg.solve(hold @ INVERSE @ hold.T, hold @ v)


def energy(v):
    return v @ MASSES @ v / 2


def state(time, step=2e-3):
    """By Runge and Kutta's method of fourth order."""
    x, v = start()
    for _ in range(round(time / step)):
        k1 = v, acceleration(x, v)
        k2 = v + step / 2 * k1[1], acceleration(x + step / 2 * k1[0], v + step / 2 * k1[1])
        k3 = v + step / 2 * k2[1], acceleration(x + step / 2 * k2[0], v + step / 2 * k2[1])
        k4 = v + step * k3[1], acceleration(x + step * k3[0], v + step * k3[1])
        x = x + step / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        v = v + step / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
    return x, v
