import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Pacing } from "../src/scene/displays/pacing";

describe("Pacing", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("updates every frame if there is no interval", () => {
    const pacing = new Pacing(() => expect.unreachable());
    expect([0, 1, 2].map((now) => pacing.shouldUpdate(now, 0))).toEqual([true, true, true]);
  });

  it("waits until the interval is over, then requests one frame", () => {
    const invalidate = vi.fn();
    const pacing = new Pacing(invalidate);
    expect([0, 100, 400].map((now) => pacing.shouldUpdate(now, 500))).toEqual([true, false, false]);
    vi.advanceTimersByTime(399);
    expect(invalidate).not.toHaveBeenCalled();
    vi.advanceTimersByTime(1);
    expect(invalidate).toHaveBeenCalledTimes(1);
    expect(pacing.shouldUpdate(500, 500)).toBe(true);
  });

  it("updates at once after a restart, and drops the pending request", () => {
    const invalidate = vi.fn();
    const pacing = new Pacing(invalidate);
    pacing.shouldUpdate(0, 500);
    pacing.shouldUpdate(10, 500);
    pacing.restart();
    expect(pacing.shouldUpdate(20, 500)).toBe(true);
    vi.runAllTimers();
    expect(invalidate).not.toHaveBeenCalled();
  });
});
