"""The compiled loop that steps a model with MuJoCo's own integrators."""

from numba import njit

from mjbeer.simulation.call import call

_LARGEST = 1e10  # mjMAXVAL: MuJoCo calls a larger state or acceleration diverged


@njit(cache=True, nogil=True)
def advance(function, models, data, views, states):
    """Take a step for each row of `states`, fill it with the state at its end, and return the number of finite rows.

    Args:
      function: address of mj_step.
      models: addresses of the models with which the parts of each step are taken, one after the other.
      data: address of their common data.
      views: qpos, qvel and qacc in that data.
      states: work space of shape (steps, nq + nv).
    """
    qpos, qvel, qacc = views
    size = qpos.size
    for row in range(len(states)):
        for model in models:
            call(function, model, data)
        for i in range(size):
            states[row, i] = qpos[i]
            states[row, size + i] = qvel[i]
            if not (abs(qpos[i]) < _LARGEST and abs(qvel[i]) < _LARGEST and abs(qacc[i]) < _LARGEST):
                return row
    return len(states)
