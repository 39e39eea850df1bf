"""A Gymnasium environment: the tip of the tour's actuator is to go where it is wanted, by the pressure at its inlet.

    python python/examples/gym_reach.py

plays one episode with a plain integral controller and prints what it was rewarded.
"""

import gymnasium
import numpy as np

import slcbeam

INLET = "/network/chains/0/ends/0/pressure_pa"
LOOKS = ["tip_u1", "tip_angle"]
# of the length, above the start: the highest pressure lifts by 0.034 within an episode, and by 0.07 in the end
REACHED = (0.005, 0.03)


class Reach(gymnasium.Env):
    """Actions are pressures from -1 (none) to 1 (the highest); observations are the target, the tip's place, angle and velocity, scaled."""

    action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float64)
    observation_space = gymnasium.spaces.Box(-100.0, 100.0, (4,), np.float64)

    def __init__(self, case="tour-actuator", highest_pa=60e3, interval_s=0.02, steps=50):
        case = slcbeam.load(case, set={"/time/end_s": interval_s * (steps + 1), "/mesh/cells_per_segment": 2, "/solver/rtol": 1e-3})
        self.interval_s, self.steps, self.highest_pa = interval_s, steps, highest_pa
        self.sim = slcbeam.Simulator(case, {INLET: (0.0, highest_pa)})
        self.size_m = case["/beam/length_m"]
        self.start = self.sim.save()
        self.looks = [self.sim.columns.index(name) for name in LOOKS]

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.sim.restore(self.start)
        self.done, self.before = 0, self.sim.row[self.looks[0]]
        self.target = self.before + self.size_m * self.np_random.uniform(*REACHED)
        return self.observe(self.sim.row), {}

    def observe(self, row):
        place, angle = row[self.looks]
        speed, self.before = (place - self.before) / self.interval_s, place
        return np.array([self.target / self.size_m, place / self.size_m, angle, speed / self.size_m])

    def step(self, action):
        pressure = 0.5 * (1.0 + float(np.clip(action[0], -1.0, 1.0))) * self.highest_pa
        seen = self.observe(self.sim.step(self.interval_s, pressure))
        self.done += 1
        return seen, -abs(seen[0] - seen[1]), False, self.done >= self.steps, {"t": self.sim.t}


if __name__ == "__main__":
    env = Reach()
    seen, _ = env.reset(seed=1)
    action, total, over = np.array([-1.0]), 0.0, False
    while not over:
        action = np.clip(action + 6.0 * (seen[0] - seen[1]), -1.0, 1.0)
        seen, reward, _, over, _ = env.step(action)
        total += reward
    print(f"off by {abs(seen[0] - seen[1]):.4f} of the length in the end, rewarded by {total:.2f}")
