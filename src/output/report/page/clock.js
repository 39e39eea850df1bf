// The time that animation, profiles, maps and histories share, and the player that moves it.

/** A clock over frames; `shown` frames a second of wall time at speed 1. */
function makeClock(times, cycle) {
  const last = times.length - 1;
  const span = times[last] - times[0];
  // A cycle of the drive in two seconds, or the whole in twelve.
  const natural = cycle && cycle < span ? cycle / 2 : span / 12;
  const clock = {
    times, index: 0, time: times[0], playing: false, rate: natural, natural, listeners: [],
    onTick(act) {
      this.listeners.push(act);
    },
    notify() {
      for (const act of this.listeners) act(this);
    },
    go(index) {
      this.index = Math.min(Math.max(Math.round(index), 0), last);
      this.time = times[this.index];
      this.notify();
    },
    goTime(t) {
      this.time = Math.min(Math.max(t, times[0]), times[last]);
      this.index = frameAt(times, this.time);
      this.notify();
    },
    play(on) {
      this.playing = on && last > 0;
      if (this.playing) {
        if (this.time >= times[last]) this.goTime(times[0]);
        before = null;
        requestAnimationFrame(frame);
      }
      this.notify();
    },
  };
  let before = null;
  function frame(now) {
    if (!clock.playing) return;
    // With reduced motion, four still pictures per second.
    if (before !== null && calm.matches && now - before < 250) {
      requestAnimationFrame(frame);
      return;
    }
    const passed = before === null ? 0 : Math.min(now - before, calm.matches ? 500 : 100) / 1000;
    before = now;
    let t = clock.time + passed * clock.rate;
    if (t > times[last]) t = times[0] + ((t - times[last]) % (span || 1));
    clock.goTime(t);
    requestAnimationFrame(frame);
  }
  return clock;
}

/** The last frame at or before a time. */
function frameAt(times, t) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t * (1 + 1e-7)) low = middle;
    else high = middle - 1;
  }
  return low;
}

const ICONS = { play: "M3 1.5v13l11-6.5z", pause: "M3 2h4v12H3zM9 2h4v12H9z", back: "M11 2v12L4 8zM2 2h2v12H2z", forth: "M5 2v12l7-6zM12 2h2v12h-2z" };
function icon(name) {
  return svg("svg", { viewBox: "0 0 16 16", width: 14, height: 14, "aria-hidden": "true" }, svg("path", { d: ICONS[name] }));
}

/** Lets a button show what it does: pause if something plays, else play. */
function showPlaying(button, playing) {
  const label = playing ? "Pause" : "Play";
  if (button.getAttribute("aria-label") === label) return button;
  button.replaceChildren(icon(playing ? "pause" : "play"));
  button.setAttribute("aria-label", label);
  return button;
}

/** Buttons, slider, speed; `numbers(clock)` gives [label, text] pairs to be read along. */
function player(clock, numbers) {
  const last = clock.times.length - 1;
  const play = showPlaying(el("button", { type: "button", class: "main" }), false);
  const step = (by, name, label) =>
    el("button", { type: "button", "aria-label": label, on: { click: () => (clock.play(false), clock.go(clock.index + by)) } }, icon(name));
  const slider = el("input", { type: "range", min: 0, max: last, step: 1, value: 0, "aria-label": "Time", id: "time" });
  const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 10];
  const speed = el("select", { "aria-label": "Speed" },
    speeds.map((x) => el("option", { value: x, text: `${quantity(x * clock.natural, "s", 2)} per second`, selected: x === 1 })));
  const shown = el("div", { class: "numbers", "aria-live": "off" });
  const spans = numbers(clock).map(([label]) => {
    const value = el("b");
    shown.append(el("span", {}, `${label} `, value));
    return value;
  });
  play.addEventListener("click", () => clock.play(!clock.playing));
  slider.addEventListener("input", () => {
    // Read first: stopping sets the slider to where the clock was.
    const index = Number(slider.value);
    clock.play(false);
    clock.go(index);
  });
  speed.addEventListener("change", () => (clock.rate = Number(speed.value) * clock.natural));
  clock.onTick(() => {
    slider.value = clock.index;
    slider.setAttribute("aria-valuetext", quantity(clock.time, "s", 4));
    numbers(clock).forEach(([, text], k) => (spans[k].textContent = text));
    showPlaying(play, clock.playing);
  });
  document.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const target = event.target;
    const own = target.closest("button, select, summary, a, textarea, [data-keys]");
    if (own && target !== slider) return;
    const by = event.shiftKey ? 10 : 1;
    const acts = {
      " ": () => clock.play(!clock.playing),
      ArrowLeft: () => (clock.play(false), clock.go(clock.index - by)),
      ArrowRight: () => (clock.play(false), clock.go(clock.index + by)),
      Home: target === slider ? () => clock.go(0) : null,
      End: target === slider ? () => clock.go(last) : null,
    };
    if (target.matches("input") && target !== slider) return;
    if (acts[event.key]) {
      event.preventDefault();
      acts[event.key]();
    }
  });
  return el("div", { class: "player", role: "group", "aria-label": "Player" },
    el("div", { class: "buttons" }, step(-1, "back", "One step back"), play, step(1, "forth", "One step on")),
    el("div", { class: "slider" }, slider), speed, shown);
}
