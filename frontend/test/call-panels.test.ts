import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { PageMessage, ServerMessage, TrajectoryController } from "../src/protocol";
import { ControllersState, listActions, listHardwareStates } from "../src/state/monitor/controllers";
import { PublishersState } from "../src/state/monitor/publishers";
import { ServicesState } from "../src/state/monitor/services";
import { TrajectoriesState } from "../src/state/monitor/trajectories";

let connection: Connection;
let sent: PageMessage[];
const receive = (message: ServerMessage): void => connection.message.emit(message);

beforeEach(() => {
  connection = new Connection("ws://localhost/ws");
  sent = [];
  vi.spyOn(connection, "send").mockImplementation((message) => void sent.push(message));
});

describe("services", () => {
  it("are called with the text of the user", () => {
    const state = new ServicesState(connection);
    state.watch(true);
    receive({ type: "service_list", services: [{ name: "/add", kind: "a/srv/Add" }] });
    state.choose("/add");
    receive({ type: "service_request", service: "/add", kind: "a/srv/Add", text: "a: 0\n", error: null });
    state.call("a: 1");
    expect(sent.at(-1)).toEqual({ type: "call_service", service: "/add", text: "a: 1" });
    expect(state.isCalling).toBe(true);
    receive({ type: "service_response", service: "/other", fields: [], seconds: 1, error: null });
    expect(state.response).toBeNull();
    receive({ type: "service_response", service: "/add", fields: [], seconds: 1, error: null });
    expect(state.isCalling).toBe(false);
  });

  it("chosen before the list arrives are asked for when it names them", () => {
    const state = new ServicesState(connection);
    const asked = { type: "choose_service", service: "/add" };
    const list: ServerMessage = { type: "service_list", services: [{ name: "/add", kind: "a/srv/Add" }] };
    state.choose("/add");
    expect(sent).toEqual([]);
    receive({ type: "service_list", services: [] });
    receive(list);
    receive(list);
    expect(sent).toEqual([asked]);
  });

  it("that no node offers cannot be called", () => {
    const state = new ServicesState(connection);
    state.choose("/missing");
    state.call("");
    expect(sent).toEqual([]);
  });
});

describe("publishers", () => {
  const texts = new Map<string, string>();
  const storage = { getItem: (key: string) => texts.get(key) ?? null, setItem: (key: string, text: string) => void texts.set(key, text) };

  it("start with the template of their type, and are off in the next visit", () => {
    const state = new PublishersState(connection, storage);
    state.add("/speed", "std_msgs/msg/Float64");
    receive({ type: "message_template", kind: "std_msgs/msg/Float64", text: "data: 0.0\n", error: null });
    const [publisher] = state.publishers;
    expect(publisher?.text).toBe("data: 0.0\n");
    state.change(publisher?.id ?? 0, { is_on: true, rate: 5 });
    const [kept] = new PublishersState(connection, storage).publishers;
    expect(kept).toMatchObject({ topic: "/speed", rate: 5, is_on: false });
  });

  it("ignore stored values that are not a list", () => {
    expect(new PublishersState(connection, { ...storage, getItem: () => "{" }).publishers).toEqual([]);
  });
});

describe("controllers", () => {
  it("of the first manager are shown, and changed", () => {
    const state = new ControllersState(connection);
    state.watch(true);
    receive({ type: "controller_managers", managers: ["/a/manager", "/b/manager"] });
    expect(sent.at(-1)).toEqual({ type: "watch_controllers", wants_list: true, manager: "/a/manager" });
    state.changeController("arm", "activate");
    expect(sent.at(-1)).toEqual({ type: "change_controller", manager: "/a/manager", name: "arm", action: "activate" });
    receive({ type: "controller_result", manager: "/a/manager", name: "arm", text: "no" });
    expect(state.problems.get("arm")).toBe("no");
    receive({ type: "controller_result", manager: "/a/manager", name: "arm", text: "" });
    expect(state.problems.size).toBe(0);
  });

  it("have the actions of their state", () => {
    expect(listActions("not loaded")).toEqual(["load"]);
    expect(listActions("inactive")).toEqual(["activate", "unload"]);
    expect(listActions("finalized")).toEqual([]);
    expect(listHardwareStates("active")).toEqual(["unconfigured", "inactive"]);
  });
});

describe("trajectories", () => {
  const controller: TrajectoryController = {
    type: "trajectory_controller",
    controller: "/arm",
    topic: "/arm/joint_trajectory",
    error: null,
    joints: [
      { name: "elbow", position: 0.5, lower: -1, upper: 1, velocity: 2 },
      { name: "wrist", position: 0.25, lower: null, upper: null, velocity: null },
    ],
  };

  it("start at the present positions, and last as long as the slowest joint needs", () => {
    vi.useFakeTimers();
    const state = new TrajectoriesState(connection);
    state.watch(true);
    receive({ type: "trajectory_controllers", controllers: ["/arm"] });
    receive(controller);
    state.move("elbow", 1);
    vi.runAllTimers();
    expect(sent.some(({ type }) => type === "move_joints")).toBe(false);
    state.turn(true);
    state.move("elbow", 0.75);
    state.move("wrist", 0.75);
    vi.runAllTimers();
    expect(sent.filter(({ type }) => type === "move_joints")).toEqual([
      { type: "move_joints", controller: "/arm", positions: [0.75, 0.75], seconds: 1 },
    ]);
    vi.useRealTimers();
  });
});
