import { describe, expect, it } from "vitest";
import type { Connection } from "../src/connection/connection";
import type { LogLine } from "../src/protocol";
import { LogState } from "../src/state/monitor/log";

const line = (message: string, time: number): LogLine => ({ level: 20, node: "talker", message, time, file: "", function: "", line: 0 });

describe("the log of a page that reconnects", () => {
  it("has each record once, although the server sends the history first", () => {
    const on = new Map<string, (message: unknown) => void>();
    const connection = { on: (type: string, take: (message: unknown) => void) => on.set(type, take), send: () => undefined };
    const log = new LogState(connection as unknown as Connection, { getItem: () => null, setItem: () => undefined });
    const tell = (...lines: LogLine[]): void => on.get("log_lines")?.({ lines, missed: 0 });
    on.get("hello")?.({});
    tell(line("a", 1), line("b", 2));
    tell(line("b", 2));
    expect(log.lines.map(({ message }) => message)).toEqual(["a", "b", "b"]);
    on.get("hello")?.({});
    tell(line("a", 1), line("b", 2), line("c", 3));
    expect(log.lines.map(({ message }) => message)).toEqual(["a", "b", "b", "c"]);
  });
});
