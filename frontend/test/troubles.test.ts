import { describe, expect, it } from "vitest";
import type { StatusRow } from "../src/protocol";
import { troublesOf } from "../src/state/displays";

const ROWS: StatusRow[] = [
  { name: "Topic", level: "warn", text: "No messages received" },
  { name: "Points", level: "ok", text: "Showing" },
  { name: "Transform", level: "error", text: "Could not transform" },
];

describe("What is wrong with a display", () => {
  it("is what of its status is no ok, errors first", () => {
    expect(troublesOf(ROWS).map((row) => row.name)).toEqual(["Transform", "Topic"]);
    expect(troublesOf([])).toEqual([]);
  });
});
