import { describe, expect, it } from "vitest";
import type { Connection } from "../src/connection/connection";
import type { LogLine } from "../src/protocol";
import { LogState } from "../src/state/monitor/log";

const createLine = (message: string, time: number): LogLine => ({ level: 20, node: "talker", message, time, file: "", function: "", line: 0 });

describe("the log of a page that reconnects", () => {
  it("has each record once, although the server sends the history first", () => {
    const listeners = new Map<string, (message: unknown) => void>();
    const connection = { on: (type: string, listener: (message: unknown) => void) => listeners.set(type, listener), send: () => undefined };
    const log = new LogState(connection as unknown as Connection, { getItem: () => null, setItem: () => undefined });
    const receiveLines = (...lines: LogLine[]): void => listeners.get("log_lines")?.({ lines, missed: 0 });
    listeners.get("hello")?.({});
    receiveLines(createLine("a", 1), createLine("b", 2));
    receiveLines(createLine("b", 2));
    expect(log.lines.map(({ message }) => message)).toEqual(["a", "b", "b"]);
    listeners.get("hello")?.({});
    receiveLines(createLine("a", 1), createLine("b", 2), createLine("c", 3));
    expect(log.lines.map(({ message }) => message)).toEqual(["a", "b", "b", "c"]);
  });
});
