import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { PageMessage, ServerMessage, Tool } from "../src/protocol";
import { SelectionState } from "../src/state/selection";
import { TimeControlState } from "../src/state/time";
import { ToolsState } from "../src/state/tools";
import { createProperty, createRobotScene } from "./messages";

let connection: Connection;
let sentMessages: PageMessage[];

function receive(message: ServerMessage): void {
  connection.message.emit(message);
}

function createTool(id: string, part: Partial<Tool> = {}): Tool {
  return { id, cls: `rviz_default_plugins/${id}`, name: id, supported: true, properties: [], ...part };
}

beforeEach(() => {
  sentMessages = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
});

describe("the tools", () => {
  it("start with the first known tool, and return to it", () => {
    const tools = new ToolsState(connection);
    receive({ type: "tools", tools: [createTool("Else", { supported: false }), createTool("Interact"), createTool("Measure")], classes: [] });
    expect(tools.current?.id).toBe("Interact");
    const [unknown, , measure] = tools.tools;
    tools.toggle(measure!);
    expect(tools.current?.id).toBe("Measure");
    tools.toggle(measure!);
    expect(tools.current?.id).toBe("Interact");
    tools.activate(unknown!);
    expect(tools.current?.id).toBe("Interact");
  });

  it("keep the active tool while the list changes, as long as it exists", () => {
    const tools = new ToolsState(connection);
    receive({ type: "tools", tools: [createTool("Interact"), createTool("Measure")], classes: [] });
    tools.activate(tools.tools[1]!);
    receive({ type: "tools", tools: [createTool("Interact"), createTool("Measure"), createTool("Select")], classes: [] });
    expect(tools.current?.id).toBe("Measure");
    receive({ type: "tools", tools: [createTool("Interact")], classes: [] });
    expect(tools.current?.id).toBe("Interact");
  });

  it("show a setting at once and send it to the server", () => {
    const tools = new ToolsState(connection);
    const click = createProperty({ id: "t/Single click", name: "Single click", kind: "bool", value: true });
    receive({ type: "tools", tools: [createTool("t", { properties: [click] })], classes: [] });
    tools.setProperty("t/Single click", false);
    expect(tools.tools[0]!.rows.bool(true, "Single click")).toBe(false);
    expect(sentMessages).toEqual([{ type: "set_tool_property", id: "t/Single click", value: false }]);
    receive({ type: "tool_property_changed", id: "t/Single click", value: true });
    expect(tools.tools[0]!.rows.bool(false, "Single click")).toBe(true);
  });
});

describe("the clocks", () => {
  it("advance by themselves while they run, and only then", () => {
    let now = 1000;
    const time = new TimeControlState(connection, () => now);
    expect(time.computeTimes()).toBeNull();
    const clock = { type: "clock", ros: 50, ros_start: 40, wall: 1e9, wall_start: 1e9 - 5 } as const;
    receive({ ...clock, running: true });
    now += 1500;
    expect(time.computeTimes()).toEqual({ ros: 51.5, rosElapsed: 11.5, wall: 1e9 + 1.5, wallElapsed: 6.5 });
    receive({ ...clock, running: false });
    now += 1500;
    expect(time.computeTimes()).toMatchObject({ ros: 50, wall: 1e9 + 1.5 });
  });

  it("are requested again after the connection was lost", () => {
    const time = new TimeControlState(connection);
    time.watch(true);
    time.watch(true);
    receive({ type: "hello", protocol: 0, version: "", title: "", run: "1" });
    expect(sentMessages).toEqual([
      { type: "watch_clock", watching: true },
      { type: "watch_clock", watching: true },
    ]);
  });
});

describe("the selection", () => {
  it("adds, removes, and reports the first selected link", () => {
    const scene = createRobotScene("d1", "base", "tip");
    const selection = new SelectionState(new Map([["d1", scene]]));
    const onChanged = vi.fn();
    selection.changed.on(onChanged);
    selection.pick([{ display: "d0", key: "7" }], "replace");
    expect(selection.selectedLink).toBeNull();
    selection.pick([{ display: "d1", key: "tip" }, { display: "d0", key: "7" }], "add");
    expect(selection.items).toHaveLength(2);
    expect(selection.selectedLink?.link.name).toBe("tip");
    selection.pick([{ display: "d1", key: "tip" }], "add");
    expect(onChanged).toHaveBeenCalledTimes(2);
    selection.pick([{ display: "d0", key: "7" }], "remove");
    expect(selection.items).toEqual([{ display: "d1", key: "tip" }]);
    selection.keepIf(() => false);
    expect(selection.selectedLink).toBeNull();
  });
});
