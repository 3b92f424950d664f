import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Connection } from "../src/connection/connection";
import type { ServerMessage } from "../src/protocol";
import { Signal } from "../src/signal";
import type { ReducedDisplay } from "../src/state/slow-connection";
import { Slowness } from "../src/state/slowness";

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("document", { hidden: false });
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function createSlowness(pace = { isSlow: false }) {
  const listeners = new Map<string, (message: ServerMessage) => void>();
  const connection = { on: (type: string, listener: (message: ServerMessage) => void) => listeners.set(type, listener) };
  const slowConnection = { changed: new Signal(), reducedDisplays: [] as ReducedDisplay[] };
  let delay = 0;
  const slowness = new Slowness(slowConnection, pace, connection as unknown as Connection, () => Date.now() + delay);
  const reduceDisplays = (displays: readonly string[]): void => {
    slowConnection.reducedDisplays = displays.map((display) => ({ display, reduction: { kind: "points", step: 2 }, rate: null }));
    slowConnection.changed.emit();
  };
  /** Delays the page's timers by this time. */
  const passTimers = (count: number, lateness: number): void => {
    for (let i = 0; i < count; i++) {
      delay += lateness;
      vi.advanceTimersByTime(50);
    }
  };
  const receiveLateness = (isLate: boolean): void => listeners.get("program_is_late")?.({ type: "program_is_late", late: isLate });
  return { slowness, reduceDisplays, passTimers, receiveLateness };
}

it("is the connection if nothing is late", () => {
  const { slowness, reduceDisplays, passTimers } = createSlowness();
  reduceDisplays(["cloud"]);
  passTimers(40, 2);
  expect(slowness.cause).toBe("line");
});

it("is the page while its timers are late", () => {
  const { slowness, reduceDisplays, passTimers } = createSlowness();
  reduceDisplays(["cloud"]);
  const onChanged = vi.fn();
  slowness.changed.on(onChanged);
  passTimers(10, 80);
  expect(slowness.cause).toBe("page");
  passTimers(60, 0);
  expect(slowness.cause).toBe("line");
  expect(onChanged).toHaveBeenCalledTimes(2);
});

it("is the program if it says so and the page is not slow", () => {
  const { slowness, reduceDisplays, passTimers, receiveLateness } = createSlowness();
  reduceDisplays(["cloud"]);
  receiveLateness(true);
  expect(slowness.cause).toBe("program");
  passTimers(10, 80);
  expect(slowness.cause).toBe("page");
});

it("checks the page only while it receives reduced data", () => {
  const { reduceDisplays } = createSlowness();
  expect(vi.getTimerCount()).toBe(0);
  reduceDisplays(["cloud"]);
  reduceDisplays(["cloud", "image"]);
  expect(vi.getTimerCount()).toBe(1);
  reduceDisplays([]);
  expect(vi.getTimerCount()).toBe(0);
});

it("is a page that draws late", () => {
  expect(createSlowness({ isSlow: true }).slowness.cause).toBe("page");
});
