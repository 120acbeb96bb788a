"""A gymnasium environment of a leg that keeps its torso at a height."""

import gymnasium as gym
import numpy as np

import carom


class Leg(gym.Env):
    """Actions are the targets of both servos; it sees `qpos`, `qvel` and the force on the sole."""

    def __init__(self, xml: str, height: float = 0.75, period: float = 0.02, duration: float = 4.0):
        self.model = carom.load_model(xml, restitution=0.0)
        self.run = carom.Run(self.model, step=2e-3, save_every=10)
        self.height, self.period, self.duration = height, period, duration
        low, high = self.model.mujoco.actuator_ctrlrange.T
        self.action_space = gym.spaces.Box(low, high, dtype=np.float64)
        self.observation_space = gym.spaces.Box(-np.inf, np.inf, (7,), dtype=np.float64)

    def reset(self, *, seed=None, options=None):
        """Begin in a crouch, a little above the floor."""
        super().reset(seed=seed)
        crouch = self.model.keyframes["crouch"]
        self.run.reset(qpos=crouch.qpos + (self.np_random.uniform(0.0, 0.1), 0.0, 0.0))
        self.run.ctrl = crouch.ctrl
        return self._seen(), {}

    def step(self, action):
        """Set the targets, and go on by a period."""
        self.run.ctrl = action
        failed = False
        try:
            self.run.advance(self.period)
        except carom.SimulationError:
            failed = True
        seen = self._seen()
        reward = 1.0 - abs(seen[0] - self.height) / self.height
        late = self.run.time > self.duration - 0.5 * self.period
        return seen, float(reward), failed, late, {}

    def _seen(self):
        state = self.run.state
        return np.concatenate([self.model.qpos(state), self.model.qvel(state), [state["sole"]]])
