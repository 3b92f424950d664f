import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { splitName } from "../src/panels/joints/joint-row";
import type { JointControl, PageMessage, ServerMessage } from "../src/protocol";
import { JointsState } from "../src/state/joints";
import { PoseStore, parseSrdf, formatSrdf, matchesPose } from "../src/state/named-poses";
import { roundTripPosition, Sweep } from "../src/state/sweep";
import { openBrowserStorage } from "../src/storage";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

function createControl(name: string, part: Partial<JointControl> = {}): JointControl {
  return { name, kind: "revolute", lower: -1, upper: 2, zero: 0, mimic: null, multiplier: 1, offset: 0, ...part };
}

describe("moving joints", () => {
  let sentMessages: PageMessage[];
  let frameCallbacks: (() => void)[];
  let joints: JointsState;
  let emit: (message: ServerMessage) => void;

  beforeEach(() => {
    sentMessages = [];
    frameCallbacks = [];
    const connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
    emit = (message) => connection.message.emit(message);
    joints = new JointsState(connection, (callback) => frameCallbacks.push(callback));
    const controls = [createControl("grip"), createControl("claw", { mimic: "grip", multiplier: -2, offset: 0.5 })];
    connection.message.emit({ type: "joints", controls: [...controls, createControl("tip", { mimic: "claw" })] });
  });

  function runFrame(): void {
    for (const callback of frameCallbacks.splice(0)) callback();
  }

  describe("of a program that was started again", () => {
    beforeEach(() => {
      emit({ type: "joint_positions", positions: { grip: 0.7, claw: -0.9, tip: 0 } });
      emit({ type: "joints", controls: null }); // sent when a program ends and when the next one starts
    });

    it("restores the moved joints once after the sliders appear", () => {
      joints.onProgramRestarted(true);
      emit({ type: "joints", controls: null });
      emit({ type: "joints", controls: [] });
      expect(sentMessages).toEqual([]);
      emit({ type: "joints", controls: [createControl("grip"), createControl("claw"), createControl("lift")] });
      emit({ type: "joints", controls: [createControl("grip")] });
      expect(sentMessages).toEqual([{ type: "set_joint", name: "grip", position: 0.7 }]);
    });

    it("does not move joints that were at zero, are gone, or belong to another robot that is shown now", () => {
      joints.onProgramRestarted(true);
      emit({ type: "joints", controls: [createControl("other")] });
      emit({ type: "joint_positions", positions: { other: 0 } });
      joints.onProgramRestarted(true);
      emit({ type: "joints", controls: [createControl("other")] });
      emit({ type: "joint_positions", positions: { other: 1 } });
      joints.onProgramRestarted(false);
      emit({ type: "joints", controls: [createControl("other")] });
      expect(sentMessages).toEqual([]);
    });
  });

  it("sends the first move immediately and the others of a frame as one", () => {
    for (const position of [0.1, 0.2, 0.3]) joints.move({ grip: position });
    joints.move({ lift: 1 });
    expect(sentMessages).toEqual([{ type: "set_joint", name: "grip", position: 0.1 }]);
    runFrame();
    expect(sentMessages[1]).toEqual({ type: "set_joints", positions: { grip: 0.3, lift: 1 } });
    runFrame();
    runFrame();
    expect(sentMessages).toHaveLength(2);
    joints.move({ grip: 0.4 });
    expect(sentMessages).toHaveLength(3);
  });

  it("finds the joint that moves a mimic joint, and its required position", () => {
    expect(joints.findLeader("grip", 0.7)?.position).toBe(0.7);
    const leader = joints.findLeader("tip", 1.5);
    expect(leader?.control.name).toBe("grip");
    expect(leader?.position).toBe(-0.5);
    expect(joints.findLeader("fixed", 0)).toBeNull();
  });
});

describe("named poses", () => {
  const home = { name: "home", positions: { a: 0.5, "b<1>": -1e-7 } };

  it("are stored for each robot, with unique names", () => {
    const storage = openBrowserStorage();
    const store = new PoseStore(storage);
    store.save("mbot", home, { name: "up", positions: { a: 1 } });
    store.save("mbot", { name: "home", positions: { a: 2 } });
    expect(new PoseStore(storage).posesOf("mbot").map((pose) => [pose.name, pose.positions["a"]])).toEqual([
      ["home", 2],
      ["up", 1],
    ]);
    expect(store.posesOf("other")).toEqual([]);
    store.remove("mbot", "home");
    expect(store.posesOf("mbot").map((pose) => pose.name)).toEqual(["up"]);
  });

  it("survive export to SRDF and import", () => {
    const poses = [home, { name: 'say "hi" & go', positions: { a: 3 } }];
    expect(parseSrdf(formatSrdf("r&d", poses))).toEqual(poses);
  });

  it("are read from a MoveIt file", () => {
    const text = `<robot name="panda">
      <!-- <group_state name="old" group="arm"><joint name="x" value="1"/></group_state> -->
      <group name="arm"><joint name="x"/></group>
      <group_state name="ready" group="arm">
        <joint name='x' value='1.5' /><joint value=" -2 " name="y"/><joint name="base" value="0 0 0"/>
      </group_state>
      <group_state group="hand" name="ready"><joint name="z" value="0"></joint></group_state>
    </robot>`;
    expect(parseSrdf(text)).toEqual([
      { name: "ready", positions: { x: 1.5, y: -2 } },
      { name: "ready (hand)", positions: { z: 0 } },
    ]);
    expect(parseSrdf("no XML at all")).toEqual([]);
  });

  it("are marked if the robot is in that pose", () => {
    expect(matchesPose(home, { a: 0.5, "b<1>": 0, c: 9 })).toBe(true);
    expect(matchesPose(home, { a: 0.51 })).toBe(false);
  });
});

describe("a sweep", () => {
  it("goes from the joint's position to both limits and back", () => {
    const range = { lower: -1, upper: 2 };
    expect([0, 1 / 3, 0.5, 5 / 6, 1].map((part) => roundTripPosition(range, 0, part))).toEqual([0, 2, 1, -1, 0]);
    for (let i = 0; i <= 100; i++) {
      const position = roundTripPosition(range, 1.5, i / 100);
      expect(position).toBeGreaterThanOrEqual(-1);
      expect(position).toBeLessThanOrEqual(2);
    }
  });

  it("moves joints one after another, each back to its start, or all at once", () => {
    const controls = [createControl("a"), createControl("b", { lower: 0, upper: 1 }), createControl("c", { mimic: "a" })];
    const start = { a: 0.5, b: 0.25 };
    const sequentialSweep = new Sweep(controls, start, "one");
    expect(sequentialSweep.positionsAt(1)).toEqual({ a: 2, b: 0.25 });
    expect(sequentialSweep.positionsAt(5)).toEqual({ a: 0.5, b: 0.75 });
    const positions = new Sweep(controls, start, "all").positionsAt(1);
    expect(positions).toEqual({ a: 2, b: 0.75 });
    expect(new Sweep([], {}, "one").positionsAt(3)).toEqual({});
  });
});

describe("the name of a joint", () => {
  it("is complete if short, and keeps its end if long", () => {
    expect(splitName("j1")).toEqual(["j1", ""]);
    expect(splitName("left_joint")).toEqual(["left_joint", ""]);
    expect(splitName("front_left_wheel_joint")).toEqual(["front_left_", "wheel_joint"]);
    expect(splitName("front_left_caster_rotation_joint")[1]).toBe("rotation_joint");
  });
});
