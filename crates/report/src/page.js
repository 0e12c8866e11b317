// What works in a report: the animations, the buttons of the legends, and the one between light and dark. Without it the page loses nothing else.
"use strict";
(() => {
  const root = document.documentElement;
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const dark = matchMedia("(prefers-color-scheme: dark)");

  // The button says where it leads.
  const theme = document.getElementById("theme");
  const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : dark.matches);
  const name = () => { theme.textContent = isDark() ? "Light page" : "Dark page"; };
  theme.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    try { localStorage.setItem("noslip-theme", root.dataset.theme); } catch { /* The choice lasts as long as the page. */ }
    name();
  });
  dark.addEventListener("change", name);
  name();
  theme.hidden = false;

  // The buttons of a legend show a run in the pictures of their scene, or hide it; its name there becomes faint.
  for (const legend of document.querySelectorAll(".legend")) {
    const runs = Array.from(legend.querySelectorAll("[aria-pressed]"));
    const drawings = legend.parentElement.querySelectorAll(".pictures svg");
    const show = (button, shown) => {
      button.setAttribute("aria-pressed", String(shown));
      for (const drawing of drawings) {
        for (const shape of drawing.querySelectorAll(`[data-run="${button.dataset.shows}"]`)) shape.classList.toggle("off", !shown);
        for (const text of drawing.querySelectorAll("text")) {
          if (text.textContent.trim() === button.textContent.trim()) text.classList.toggle("faint", !shown);
        }
      }
    };
    for (const button of runs) {
      button.addEventListener("click", () => show(button, button.getAttribute("aria-pressed") !== "true"));
    }
    for (const [name, shown] of [["all", true], ["none", false]]) {
      legend.querySelector(`[data-shows="${name}"]`).addEventListener("click", () => runs.forEach((run) => show(run, shown)));
    }
    legend.hidden = false;
  }

  // 0.1, 0.2, 0.5, 1, 2, 5, ..: the k-th from 1 on.
  const round = (k) => Number(`${[1, 2, 5][((k % 3) + 3) % 3]}e${Math.floor(k / 3)}`);
  // A whole run takes about so many seconds, unless asked for otherwise.
  const WHOLE = 15;
  // Who wants less motion sees a picture every half second.
  const PAUSE = 500;

  class Animation {
    constructor(figure) {
      this.figure = figure;
      const find = (what) => figure.querySelector(what);
      [this.trail, this.sleigh, this.rotor] = [find(".trail"), find(".sleigh"), find(".rotor")];
      [this.bars, this.behind] = [find(".bars"), Array.from(figure.querySelectorAll(".follower"))];
      [this.button, this.slider, this.clock, this.speed] = ["button", "input", "output", "select"].map(find);
      const [start, end] = [Number(this.slider.min), Number(this.slider.max)];
      Object.assign(this, { start, end, time: start, frame: 0, playing: false, last: null, inView: false });
      const whole = end - start;
      this.digits = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(whole))));
      const middle = Math.round(3 * Math.log10(whole / WHOLE));
      for (let k = middle - 3; k <= middle + 3; k += 1) {
        this.speed.add(new Option(`${round(k)}×`, round(k), k === middle, k === middle));
      }
      this.button.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
      this.slider.addEventListener("input", () => { this.pause(); this.show(Number(this.slider.value)); });
      // What is scrolled away pauses; what has not been seen yet may have been started all the same.
      new IntersectionObserver((seen) => {
        const inView = seen[seen.length - 1].isIntersecting;
        if (this.inView && !inView) this.pause();
        this.inView = inView;
      }).observe(figure);
      this.tell();
      find(".controls").hidden = false;
    }

    // The nodes are read when they are first asked for.
    get nodes() {
      const nodes = JSON.parse(this.figure.querySelector("script").textContent);
      nodes.points = nodes.x.map((x, k) => `${x},${nodes.y[k]}`);
      Object.defineProperty(this, "nodes", { value: nodes });
      return nodes;
    }

    play() {
      if (this.time >= this.end) this.show(this.start);
      this.playing = true;
      this.last = null;
      this.button.textContent = "Pause";
      this.next();
    }

    pause() {
      this.playing = false;
      this.button.textContent = "Play";
    }

    next() {
      const step = () => this.step(performance.now());
      if (calm.matches) setTimeout(step, PAUSE);
      else requestAnimationFrame(step);
    }

    step(now) {
      if (!this.playing) return;
      const passed = this.last === null ? 0 : (now - this.last) / 1000;
      this.last = now;
      this.show(Math.min(this.end, this.time + passed * Number(this.speed.value)));
      if (this.time >= this.end) this.pause();
      else this.next();
    }

    // The scene at a time, on the straight line between two nodes.
    show(time) {
      const { t, x, y, heading, rotor, followers, points } = this.nodes;
      let [lo, hi] = [0, t.length - 1];
      while (hi - lo > 1) {
        const middle = (lo + hi) >> 1;
        if (t[middle] <= time) lo = middle; else hi = middle;
      }
      const share = hi > lo ? Math.min(1, Math.max(0, (time - t[lo]) / (t[hi] - t[lo]))) : 0;
      const at = (values) => values[lo] + share * (values[hi] - values[lo]);
      const place = `${at(x).toFixed(1)},${at(y).toFixed(1)}`;
      this.trail.setAttribute("points", `${points.slice(0, lo + 1).join(" ")} ${place}`);
      this.sleigh.setAttribute("transform", `translate(${place}) rotate(${(-at(heading)).toFixed(2)})`);
      if (rotor) this.rotor.setAttribute("transform", `rotate(${(-at(rotor)).toFixed(2)})`);
      if (followers) {
        const places = followers.map((blade, k) => {
          const at_blade = `${at(blade.x).toFixed(1)},${at(blade.y).toFixed(1)}`;
          this.behind[k].setAttribute("transform", `translate(${at_blade}) rotate(${(-at(blade.heading)).toFixed(2)})`);
          return at_blade;
        });
        this.bars.setAttribute("points", [place, ...places].join(" "));
      }
      this.time = time;
      this.frame += 1;
      this.tell();
    }

    tell() {
      const text = `t = ${this.time.toFixed(this.digits)} s`;
      this.slider.value = this.time;
      this.slider.setAttribute("aria-valuetext", text);
      this.clock.textContent = text;
      this.figure.dataset.frame = this.frame;
    }
  }

  const animations = Array.from(document.querySelectorAll(".animation"), (figure) => new Animation(figure));
  // `index.html#play` starts the first one, unless less motion is wanted.
  if (location.hash === "#play" && animations.length > 0 && !calm.matches) {
    animations[0].figure.scrollIntoView();
    animations[0].play();
  }
  root.dataset.ready = animations.length;
})();
