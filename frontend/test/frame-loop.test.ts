import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FrameLoop } from "../src/scene/frame-loop";

let now = 0;
let waiting: (() => void)[] = [];

/** Lets a screen of 60 Hz run for a while; each animation frame comes `lag` late. */
function run(ms: number, each: () => void = () => undefined, lag = 0): void {
  const end = now + ms;
  while (now < end) {
    now += 1000 / 60 + lag;
    const due = waiting;
    waiting = [];
    for (const callback of due) callback();
    each();
    vi.advanceTimersByTime(1000 / 60 + lag);
  }
}

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout"] });
  [now, waiting] = [0, []];
  vi.stubGlobal("performance", { now: () => now });
  vi.stubGlobal("window", { setTimeout });
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => waiting.push(callback));
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("the frame loop", () => {
  it("draws nothing while nothing changes", () => {
    const draw = vi.fn();
    const loop = new FrameLoop(draw);
    run(1000);
    expect(draw).not.toHaveBeenCalled();
    loop.invalidate();
    run(1000);
    const drawn = loop.framesDrawn;
    run(5000);
    expect(loop.framesDrawn).toBe(drawn);
    expect(loop.framesPerSecond(now)).toBeNull();
  });

  it("keeps to the rate", () => {
    const loop = new FrameLoop(() => undefined);
    loop.rate = 30;
    run(2000, () => loop.invalidate());
    expect(loop.framesDrawn).toBeGreaterThan(55);
    expect(loop.framesDrawn).toBeLessThan(62);
  });

  it("draws the first frame coarsely, for speed, and a fine one soon after", () => {
    const fine: boolean[] = [];
    const loop = new FrameLoop((each) => fine.push(each));
    loop.invalidate();
    run(100);
    expect(loop.settled).toBe(false);
    run(900);
    expect(fine).toEqual([false, true]);
    expect(loop.settled).toBe(true);
    loop.invalidate();
    expect(loop.settled).toBe(false);
  });

  it("draws coarsely while a slow machine moves, finely when it stands still", () => {
    const fine: boolean[] = [];
    const loop = new FrameLoop((each) => fine.push(each));
    run(3000, () => loop.invalidate(), 100);
    expect(fine.at(-1)).toBe(false);
    run(1000);
    expect(fine.at(-1)).toBe(true);
  });
});
