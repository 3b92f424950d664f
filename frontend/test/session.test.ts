import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { PageMessage, ServerMessage, TerminalItem } from "../src/protocol";
import { Session } from "../src/state/session";
import { createDisplay, createProperty, createRobotScene, createTree } from "./messages";

let sentMessages: PageMessage[];
let session: Session;

function receive(...messages: ServerMessage[]): void {
  for (const message of messages) session.connection.message.emit(message);
}

beforeEach(() => {
  sentMessages = [];
  vi.useFakeTimers();
  vi.stubGlobal("window", { setTimeout });
  const connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  session = new Session(connection);
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("properties", () => {
  it("are found by their names and changed by their IDs", () => {
    const style = createProperty({
      id: "d0/Line Style",
      name: "Line Style",
      kind: "enum",
      value: "Lines",
      children: [createProperty({ id: "d0/Line Style/Line Width", name: "Line Width", value: 0.03 })],
    });
    receive(createTree(createDisplay({ id: "d0", properties: [style] })));
    const { rows } = session.displays.displays[0]!;
    expect(rows.text("", "Line Style")).toBe("Lines");
    receive({ type: "property_changed", id: "d0/Line Style/Line Width", value: 0.1, options: null });
    expect(rows.number(0, "Line Style", "Line Width")).toBe(0.1);
    expect(rows.number(42, "No", "Such", "Row")).toBe(42);
  });

  it("set by the user are shown at once and sent to the server", () => {
    receive(createTree(createDisplay({ id: "d0", properties: [createProperty({ id: "d0/Alpha", name: "Alpha", value: 0.5 })] })));
    session.setProperty("d0/Alpha", 0.9);
    expect(session.displays.displays[0]!.rows.number(0, "Alpha")).toBe(0.9);
    expect(sentMessages).toEqual([{ type: "set_property", id: "d0/Alpha", value: 0.9 }]);
  });

  it("do not include Enabled, which is the display's box", () => {
    const enabledProperty = createProperty({ id: "d0/Enabled", name: "Enabled", kind: "bool", value: true });
    receive(createTree(createDisplay({ id: "d0", properties: [enabledProperty] })));
    const [grid] = session.displays.displays;
    expect(grid!.rows.nodes).toHaveLength(0);
    receive({ type: "property_changed", id: "d0/Enabled", value: false, options: null });
    expect(grid!.isEnabled).toBe(false);
  });

  it("survive a new tree in the same display object, so that its drawing continues", () => {
    receive(createTree(createDisplay({ id: "d0" }), createDisplay({ id: "d1" })));
    const [first] = session.displays.displays;
    receive(createTree(createDisplay({ id: "d0", name: "Floor" })));
    expect(session.displays.displays).toEqual([first]);
    expect(first!.name).toBe("Floor");
  });
});

describe("the selection", () => {
  const model = createDisplay({ id: "d1", cls: "rviz_default_plugins/RobotModel" });

  it("survives a reload of the robot and ends with its link", () => {
    receive(createTree(model), createRobotScene("d1", "base_link", "wheel"));
    const link = session.robots.get("d1")!.links[1]!;
    session.selection.select({ display: "d1", link });
    receive(createRobotScene("d1", "base_link", "wheel"));
    expect(session.selection.selectedLink?.link.name).toBe("wheel");
    expect(session.selection.selectedLink?.link).not.toBe(link);
    receive(createRobotScene("d1", "base_link"));
    expect(session.selection.selectedLink).toBeNull();
  });
});

describe("the view", () => {
  const createViewState = (yaw: number, revision = 1, isWholeRobot = false): ServerMessage => ({
    type: "view_state",
    view: { ...session.view.current, values: { ...session.view.values, Yaw: yaw, Distance: 1.7 } },
    revision,
    whole_robot: isWholeRobot,
  });
  const size = { width: 800, height: 600 };
  const box = { min: [-1, -1, 0], max: [1, 1, 2] } as const;

  it("is taken from the server once; a reconnection does not move the user's camera", () => {
    receive(createViewState(1));
    expect(session.view.values).toMatchObject({ Yaw: 1, Distance: 1.7 });
    session.view.update({ Yaw: 2 });
    receive(createViewState(1));
    expect(session.view.values["Yaw"]).toBe(2);
    session.view.reset();
    expect(session.view.values["Yaw"]).toBe(1);
  });

  describe("of a program that was started again", () => {
    const createHello = (run: string, title = "robot.urdf"): ServerMessage => ({ type: "hello", protocol: 1, version: "1", title, run });
    const listSizes = (): unknown[] => sentMessages.filter(({ type }) => type === "robot_measured");

    it("keeps the camera, and reports the robot's size again", () => {
      receive(createHello("first"));
      receive(createViewState(1));
      session.view.update({ Yaw: 2 });
      session.view.reportSize(box, 0);
      expect(listSizes()).toHaveLength(0);
      receive(createHello("second"));
      receive(createViewState(1));
      expect(session.view.values["Yaw"]).toBe(2);
      expect(session.view.awaitsSize).toBe(true);
      session.view.reportSize(box, 0);
      session.view.reportSize(box, 0);
      expect(listSizes()).toHaveLength(1);
    });

    it("is the program's if that shows another file", () => {
      receive(createHello("first"));
      receive(createViewState(1));
      session.view.update({ Yaw: 2 });
      receive(createHello("second", "other.urdf"));
      receive(createViewState(3));
      expect(session.view.values["Yaw"]).toBe(3);
    });
  });

  it("of another file moves the camera", () => {
    receive(createViewState(1));
    session.view.update({ Yaw: 2 });
    receive(createViewState(3, 2));
    expect(session.view.values["Yaw"]).toBe(3);
  });

  it("that no user has chosen fits the whole robot, again when more of it becomes visible", () => {
    receive(createViewState(1, 1, true));
    expect(session.view.awaitsFit("")).toBe(false);
    expect(session.view.awaitsFit("2 links")).toBe(true);
    session.view.fitFirst(box, size, "2 links");
    expect(session.view.values).toMatchObject({ Yaw: 1, "Focal Point/X": 0, "Focal Point/Z": 1 });
    expect(session.view.awaitsFit("2 links")).toBe(false);
    expect(session.view.awaitsFit("3 links")).toBe(true);
    session.view.fitFirst({ min: [0, 0, 0], max: [1, 1, 1] }, size, "3 links");
    expect(session.view.values["Focal Point/Z"]).toBe(1);
    session.view.fitFirst({ min: [-1, -1, 0], max: [1, 1, 4] }, size, "4 links");
    expect(session.view.values["Focal Point/Z"]).toBe(2);
    session.view.update({ Yaw: 2 });
    expect(session.view.awaitsFit("5 links")).toBe(false);
    session.view.reset();
    expect(session.view.awaitsFit("4 links")).toBe(true);
  });

  it("that no user has chosen measures the robot once for each configuration", () => {
    const listSizes = (): unknown[] => sentMessages.filter(({ type }) => type === "robot_measured");
    receive(createViewState(1, 1, true));
    session.view.reportSize({ min: [0, 0, 0], max: [2, 3, 6] }, -0.5);
    session.view.reportSize({ min: [0, 0, 0], max: [4, 6, 12] }, 0);
    expect(listSizes()).toEqual([{ type: "robot_measured", diagonal: 7, ground: -0.5 }]);
    receive(createViewState(1, 2, true));
    session.view.update({ Yaw: 2 });
    session.view.reportSize({ min: [0, 0, 0], max: [2, 3, 6] }, 0);
    expect(listSizes()).toHaveLength(1);
  });

  it("stays where the user or the file has put it", () => {
    receive(createViewState(1));
    expect(session.view.awaitsFit("3 links")).toBe(false);
    receive(createViewState(1, 2, true));
    session.view.update({ Yaw: 2 });
    expect(session.view.awaitsFit("3 links")).toBe(false);
    receive(createViewState(1, 2, true));
    expect(session.view.awaitsFit("3 links")).toBe(false);
    session.view.reset();
    session.view.setClass("rviz_default_plugins/FPS");
    expect(session.view.awaitsFit("3 links")).toBe(false);
  });

  it("is sent to the server when the user moves it, a few times per second", () => {
    receive(createViewState(1));
    for (let i = 0; i < 20; i++) session.view.update({ Yaw: 2 + i / 100 });
    vi.advanceTimersByTime(1000);
    expect(sentMessages).toHaveLength(1);
    expect(sentMessages[0]).toMatchObject({ type: "view_changed", view: { values: { Yaw: 2.19 } } });
  });

  it("does not jump when its target frame changes", () => {
    receive({ type: "frame_table", revision: 1, names: ["base", "arm"], parents: [-1, 0] });
    session.frames.poses.set([5, 6, 7, 0, 0, 0, 1], 7);
    const positionBefore = session.view.camera.position;
    session.view.setTargetFrame("arm");
    expect(session.view.values).toMatchObject({ "Focal Point/X": -5, "Focal Point/Y": -6, "Focal Point/Z": -7 });
    expect(session.view.target.position).toEqual([5, 6, 7]);
    session.view.camera.position.forEach((value, i) => expect(value).toBeCloseTo(positionBefore[i] ?? 0));
  });
});

describe("a text editor", () => {
  const base = { display: "d0", kind: "link", name: "base" } as const;

  beforeEach(() => {
    receive(createTree(createDisplay({ id: "d0" })), createRobotScene("d0", "base", "arm"));
    sentMessages.length = 0;
  });

  it("hears of what the user selects, and not of what it has selected itself", () => {
    session.focus.select(base);
    expect(sentMessages).toEqual([]);
    session.focus.select(null);
    receive({ type: "editor_attached" }, { type: "show_element", ...base });
    expect(session.focus.current).toEqual(base);
    expect(sentMessages).toEqual([]);
    session.focus.select({ ...base, name: "arm" });
    expect(sentMessages).toEqual([{ type: "element_selected", ...base, name: "arm" }]);
  });
});

describe("terminals", () => {
  const receiveTerminals = (run: string, ...items: TerminalItem[]): void =>
    receive({ type: "hello", protocol: 0, version: "", title: "", run }, { type: "terminals", folder: "/ws", terminals: items, refusal_reason: "" });
  const createTerminal = (id: number, place: TerminalItem["shown"]): TerminalItem => ({ id, shown: place, status: null });

  it("that the page showed on a lost connection are not those of another page", () => {
    receiveTerminals("first");
    receive({ type: "terminals", folder: "/ws", terminals: [createTerminal(1, "here"), createTerminal(2, "elsewhere")], refusal_reason: "" });
    receiveTerminals("first", createTerminal(1, "elsewhere"), createTerminal(2, "elsewhere"));
    expect(session.terminals.items.map(({ shown }) => shown)).toEqual(["nowhere", "elsewhere"]);
    receive({ type: "terminals", folder: "/ws", terminals: [createTerminal(1, "elsewhere")], refusal_reason: "" });
    expect(session.terminals.items.map(({ shown }) => shown)).toEqual(["elsewhere"]);
  });

  it("of a program that was started again are others", () => {
    receiveTerminals("first");
    receive({ type: "terminals", folder: "/ws", terminals: [createTerminal(1, "here")], refusal_reason: "" });
    receiveTerminals("second", createTerminal(1, "elsewhere"));
    expect(session.terminals.items.map(({ shown }) => shown)).toEqual(["elsewhere"]);
  });
});
