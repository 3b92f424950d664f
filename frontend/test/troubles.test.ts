import { describe, expect, it } from "vitest";
import type { StatusRow } from "../src/protocol";
import { DisplaysState, problemsOf } from "../src/state/displays";
import { createDisplay, createTree } from "./messages";

const ROWS: StatusRow[] = [
  { name: "Topic", level: "warn", text: "No messages received" },
  { name: "Points", level: "ok", text: "Showing" },
  { name: "Transform", level: "error", text: "Could not transform" },
];

describe("the problems of a display", () => {
  it("are its status rows that are not ok, errors first", () => {
    expect(problemsOf(ROWS).map((row) => row.name)).toEqual(["Transform", "Topic"]);
    expect(problemsOf([])).toEqual([]);
  });

  it("are counted if they are errors and the display is enabled", () => {
    const displays = new DisplaysState();
    const warned = ROWS.slice(0, 2);
    displays.setTree(
      createTree(
        createDisplay({ id: "a", enabled: true, status: ROWS }),
        createDisplay({ id: "b", enabled: true, status: warned }),
        createDisplay({ id: "c", enabled: false, status: ROWS }),
      ),
    );
    expect(displays.failingCount).toBe(1);
    displays.setStatus("global", "error", ROWS);
    displays.setStatus("b", "error", ROWS);
    expect(displays.failingCount).toBe(3);
    displays.setStatus("a", "ok", []);
    expect(displays.failingCount).toBe(2);
  });
});
