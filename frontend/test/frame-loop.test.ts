import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FINEST_DETAIL, FrameLoop } from "../src/scene/frame-loop";

let now = 0;
let scheduledCallbacks: (() => void)[] = [];

/** Simulates a screen of 60 Hz for a while; each animation frame is late by `lag` milliseconds. */
function runScreen(ms: number, onFrame: () => void = () => undefined, lag = 0): void {
  const end = now + ms;
  while (now < end) {
    now += 1000 / 60 + lag;
    const dueCallbacks = scheduledCallbacks;
    scheduledCallbacks = [];
    for (const callback of dueCallbacks) callback();
    onFrame();
    vi.advanceTimersByTime(1000 / 60 + lag);
  }
}

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout"] });
  [now, scheduledCallbacks] = [0, []];
  vi.stubGlobal("performance", { now: () => now });
  vi.stubGlobal("window", { setTimeout });
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => scheduledCallbacks.push(callback));
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("the frame loop", () => {
  it("draws nothing while nothing changes", () => {
    const draw = vi.fn();
    const loop = new FrameLoop(draw);
    runScreen(1000);
    expect(draw).not.toHaveBeenCalled();
    loop.invalidate();
    runScreen(1000);
    const drawnCount = loop.framesDrawn;
    runScreen(5000);
    expect(loop.framesDrawn).toBe(drawnCount);
    expect(loop.computeFrameRate(now)).toBeNull();
  });

  it("draws nothing while suspended, and the pending frame afterwards", () => {
    const draw = vi.fn();
    const loop = new FrameLoop(draw, true);
    loop.invalidate();
    loop.redraw(FINEST_DETAIL);
    runScreen(1000);
    expect(draw).not.toHaveBeenCalled();
    expect(loop.isSettled).toBe(false);
    loop.release();
    runScreen(100);
    expect(draw).toHaveBeenCalledTimes(1);
    loop.redraw(FINEST_DETAIL);
    expect(draw).toHaveBeenCalledTimes(2);
  });

  it("shows elements outside the scene even while suspended", () => {
    const loop = new FrameLoop(() => undefined, true);
    const show = vi.fn();
    loop.schedule(show);
    runScreen(100);
    expect(show).toHaveBeenCalledTimes(1);
  });

  it("does not draw the first frames more coarsely because of the time that shaders take to compile", () => {
    const details: number[] = [];
    const loop = new FrameLoop(({ resolutionShare }) => {
      details.push(resolutionShare);
      if (details.length <= 6) now += 300;
    });
    runScreen(6000, () => loop.invalidate());
    expect(new Set(details)).toEqual(new Set([1]));
  });

  it("keeps to the frame rate", () => {
    const loop = new FrameLoop(() => undefined);
    loop.rate = 30;
    runScreen(2000, () => loop.invalidate());
    expect(loop.framesDrawn).toBeGreaterThan(55);
    expect(loop.framesDrawn).toBeLessThan(62);
  });

  it("draws as many frames as requested even if some are late", () => {
    const loop = new FrameLoop(() => undefined);
    loop.rate = 30;
    runScreen(1000, () => loop.invalidate());
    const [countBefore, startTime] = [loop.framesDrawn, now];
    for (let round = 0; round < 10; round++) {
      runScreen(17, () => loop.invalidate(), 17);
      runScreen(300, () => loop.invalidate());
    }
    const expectedCount = (30 * (now - startTime)) / 1000;
    expect(loop.framesDrawn - countBefore).toBeGreaterThan(expectedCount - 2);
    expect(loop.framesDrawn - countBefore).toBeLessThan(expectedCount + 2);
  });

  it("draws the first frame coarsely, for speed, and a fine one soon afterwards", () => {
    const antialiasedFrames: boolean[] = [];
    const loop = new FrameLoop(({ isAntialiased }) => antialiasedFrames.push(isAntialiased));
    loop.invalidate();
    runScreen(100);
    expect(loop.isSettled).toBe(false);
    runScreen(900);
    expect(antialiasedFrames).toEqual([false, true]);
    expect(loop.isSettled).toBe(true);
    loop.invalidate();
    expect(loop.isSettled).toBe(false);
  });

  it("draws coarsely during motion on a slow machine, and finely at rest", () => {
    const antialiasedFrames: boolean[] = [];
    const loop = new FrameLoop(({ isAntialiased }) => antialiasedFrames.push(isAntialiased));
    runScreen(3000, () => loop.invalidate(), 100);
    expect(antialiasedFrames.at(-1)).toBe(false);
    runScreen(1000);
    expect(antialiasedFrames.at(-1)).toBe(true);
  });

  it("draws motion coarsely from the start on a machine known to be slow", () => {
    const movingFrames: boolean[] = [];
    const loop = new FrameLoop((detail) => movingFrames.push(detail.isMoving));
    loop.expectSlow();
    runScreen(1000, () => loop.invalidate());
    expect(movingFrames).not.toContain(false);
    runScreen(500);
    expect(movingFrames.at(-1)).toBe(false);
    runScreen(12_000, () => loop.invalidate());
    expect(movingFrames.at(-1)).toBe(false);
  });

  it("lowers the resolution during motion, and restores it once the machine has kept up for a while", () => {
    const shares: number[] = [];
    const loop = new FrameLoop(({ resolutionShare }) => shares.push(resolutionShare));
    runScreen(5000, () => loop.invalidate(), 30);
    expect(shares.at(-1)).toBe(0.5);
    runScreen(15_000, () => loop.invalidate());
    expect(shares.at(-1)).toBe(0.7);
    runScreen(1000);
    expect(shares.at(-1)).toBe(1);
  });

  it("shows elements outside the scene together with frames, and draws none for them alone", () => {
    const draw = vi.fn();
    const show = vi.fn();
    const loop = new FrameLoop(draw);
    loop.invalidate();
    runScreen(1000);
    draw.mockClear();
    runScreen(1000, () => loop.schedule(show));
    expect(draw).not.toHaveBeenCalled();
    expect(show.mock.calls.length).toBeGreaterThan(27);
    expect(show.mock.calls.length).toBeLessThan(32);
    loop.schedule(show);
    expect(loop.isSettled).toBe(false);
    runScreen(100);
    expect(loop.isSettled).toBe(true);
    const times: number[] = [];
    const [shownCount, drawnCount] = [show.mock.calls.length, loop.framesDrawn];
    runScreen(1000, () => {
      loop.schedule(() => times.push(now));
      loop.invalidate();
    });
    expect(new Set(times).size).toBe(loop.framesDrawn - drawnCount);
    expect(show.mock.calls.length).toBe(shownCount);
  });
});
