import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Connection } from "../src/connection/connection";
import type { ServerMessage } from "../src/protocol";
import { Signal } from "../src/signal";
import type { Reduced } from "../src/state/slow-connection";
import { Slowness } from "../src/state/slowness";

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("document", { hidden: false });
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function made(pace = { isSlow: false }) {
  const listeners = new Map<string, (message: ServerMessage) => void>();
  const connection = { on: (type: string, listener: (message: ServerMessage) => void) => listeners.set(type, listener) };
  const line = { changed: new Signal(), reduced: [] as Reduced[] };
  let behind = 0;
  const slowness = new Slowness(line, pace, connection as unknown as Connection, () => Date.now() + behind);
  const reduce = (displays: readonly string[]): void => {
    line.reduced = displays.map((display) => ({ display, reduction: { kind: "points", step: 2 }, rate: null }));
    line.changed.emit();
  };
  /** Delays the page's timers by this time. */
  const pass = (count: number, late: number): void => {
    for (let i = 0; i < count; i++) {
      behind += late;
      vi.advanceTimersByTime(50);
    }
  };
  const tell = (late: boolean): void => listeners.get("program_is_late")?.({ type: "program_is_late", late });
  return { slowness, reduce, pass, tell };
}

it("is the connection if nothing is late", () => {
  const { slowness, reduce, pass } = made();
  reduce(["cloud"]);
  pass(40, 2);
  expect(slowness.cause).toBe("line");
});

it("is the page while its timers are late", () => {
  const { slowness, reduce, pass } = made();
  reduce(["cloud"]);
  const changed = vi.fn();
  slowness.changed.on(changed);
  pass(10, 80);
  expect(slowness.cause).toBe("page");
  pass(60, 0);
  expect(slowness.cause).toBe("line");
  expect(changed).toHaveBeenCalledTimes(2);
});

it("is the program if it says so and the page is not slow", () => {
  const { slowness, reduce, pass, tell } = made();
  reduce(["cloud"]);
  tell(true);
  expect(slowness.cause).toBe("program");
  pass(10, 80);
  expect(slowness.cause).toBe("page");
});

it("checks the page only while it receives reduced data", () => {
  const { reduce } = made();
  expect(vi.getTimerCount()).toBe(0);
  reduce(["cloud"]);
  reduce(["cloud", "image"]);
  expect(vi.getTimerCount()).toBe(1);
  reduce([]);
  expect(vi.getTimerCount()).toBe(0);
});

it("is a page that draws late", () => {
  expect(made({ isSlow: true }).slowness.cause).toBe("page");
});
