import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { formatHex, createEntityItems } from "../src/panels/modeling/entity-items";
import type { ModelingState, PageMessage, WorldEntity } from "../src/protocol";
import { AngleUnits } from "../src/state/angle-unit";
import { Modeling } from "../src/state/modeling/modeling";
import { placementAt, createResizeChange, scaleSize, computeStretchFactors, wallPlacementBetween } from "../src/state/modeling/shapes";
import { Snapping, snap } from "../src/state/modeling/snapping";
import { openBrowserStorage } from "../src/storage";
import type { TreeItem } from "../src/tree/tree-item";

// The page's texts read the browser's language when they are imported.
vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

let sentMessages: PageMessage[];
let connection: Connection;
let modeling: Modeling;

function createEntity(part: Partial<WorldEntity> & Pick<WorldEntity, "name">): WorldEntity {
  const size = [1, 1, 1];
  return { kind: "model", pose: [0, 0, 0.5, 0, 0, 0], static: false, shape: "box", size, color: null, address: null, parts: [], ...part };
}

function receiveState(part: Partial<ModelingState>, ...entities: WorldEntity[]): void {
  const state = { available: true, active: true, file: "/w.sdf", unsaved: false, can_undo: false, can_redo: false };
  connection.message.emit({ type: "modeling_state", ...state, ...part, entities });
}

beforeEach(() => {
  sentMessages = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  modeling = new Modeling(connection, openBrowserStorage());
});

describe("snapping", () => {
  it("rounds to multiples of a step, without rounding errors", () => {
    expect(snap(0.34, 0.1)).toBe(0.3);
    expect(snap(-0.26, 0.25)).toBe(-0.25);
    expect(snap(0.1234, 0)).toBe(0.1234);
  });

  it("is inverted by Ctrl, and stored", () => {
    const storage = openBrowserStorage();
    const snapping = new Snapping(storage);
    [snapping.meters, snapping.degrees] = [0.5, 90];
    expect(snapping.chooseSteps(false)).toEqual({ length: 0.5, angle: Math.PI / 2 });
    expect(snapping.chooseSteps(true)).toEqual({ length: 0, angle: 0 });
    snapping.isEnabled = false;
    const restoredSnapping = new Snapping(storage);
    expect([restoredSnapping.isEnabled, restoredSnapping.meters, restoredSnapping.degrees]).toEqual([false, 0.5, 90]);
    expect(restoredSnapping.chooseSteps(true).length).toBe(0.5);
  });
});

describe("shapes", () => {
  it("are placed on the ground", () => {
    expect(placementAt("box", [1, 2])).toEqual({ pose: [1, 2, 0.25, 0, 0, 0], size: [0.5, 0.5, 0.5] });
    expect(placementAt("sphere", [0, 0]).pose[2]).toBe(0.25);
    expect(placementAt("point_light", [0, 0])).toEqual({ pose: [0, 0, 2, 0, 0, 0], size: [] });
    expect(placementAt("model", [3, 4]).pose).toEqual([3, 4, 0, 0, 0, 0]);
  });

  it("include a wall from one point to another", () => {
    const wall = wallPlacementBetween([1, 1], [1, 4]);
    expect(wall).toEqual({ pose: [1, 2.5, 0.5, 0, 0, Math.PI / 2], size: [3, 0.1, 1] });
    expect(wallPlacementBetween([1, 1], [1, 1])).toBeNull();
  });

  it("scale along their axes, round ones by the axis scaled most, never to zero", () => {
    expect(scaleSize("box", [1, 2, 3], [2, 1, 0.5], 0.1)).toEqual([2, 2, 1.5]);
    expect(scaleSize("cylinder", [0.5, 1], [1, 0.5, 1], 0)).toEqual([0.25, 1]);
    expect(scaleSize("sphere", [0.5], [1, 1, 3], 0)).toEqual([1.5]);
    expect(scaleSize("box", [1, 1, 1], [0, 1, 1], 0.25)).toEqual([0.25, 1, 1]);
    expect(scaleSize("box", [0.33, 1, 1], [1, 2, 1], 0.1)).toEqual([0.33, 2, 1]);
    expect(computeStretchFactors("cylinder", [0.5, 1], [1, 3])).toEqual([2, 2, 3]);
  });

  it("keep their lowest point in place while they are upright", () => {
    expect(createResizeChange(createEntity({ name: "box" }), [1, 1, 3])).toEqual({ name: "box", size: [1, 1, 3], pose: [0, 0, 1.5, 0, 0, 0] });
    const tiltedBox = createEntity({ name: "box", pose: [0, 0, 0.5, 0.1, 0, 0] });
    expect(createResizeChange(tiltedBox, [1, 1, 3])).toEqual({ name: "box", size: [1, 1, 3] });
  });
});

describe("the selection", () => {
  it("is replaced, or extended and reduced with Shift", () => {
    receiveState({}, createEntity({ name: "a" }), createEntity({ name: "b" }));
    modeling.select(["a"]);
    modeling.select(["b"], "toggle");
    expect(modeling.selectedNames).toEqual(["a", "b"]);
    modeling.select(["a"], "toggle");
    expect(modeling.selectedNames).toEqual(["b"]);
  });

  it("contains entities that this page has created, and no removed ones", () => {
    receiveState({}, createEntity({ name: "a" }));
    modeling.select(["a"]);
    receiveState({}, createEntity({ name: "a" }), createEntity({ name: "of another page" }));
    expect(modeling.selectedNames).toEqual(["a"]);
    modeling.add({ kind: "box", address: "" }, placementAt("box", [0, 0]));
    receiveState({ can_undo: true }, createEntity({ name: "a" }), createEntity({ name: "box" }));
    expect(modeling.selectedNames).toEqual(["box"]);
    receiveState({ can_redo: true }, createEntity({ name: "a" }));
    expect(modeling.selectedNames).toEqual([]);
  });

  it("follows an entity that is renamed, unless the server refuses", () => {
    receiveState({}, createEntity({ name: "a" }));
    modeling.select(["a"]);
    modeling.change([{ name: "a", new_name: "b" }]);
    receiveState({}, createEntity({ name: "b" }));
    expect(modeling.selectedNames).toEqual(["b"]);
    modeling.change([{ name: "b", new_name: "c" }]);
    connection.message.emit({ type: "simulation_notice", text: "no" });
    receiveState({}, createEntity({ name: "b" }), createEntity({ name: "d" }));
    expect(modeling.selectedNames).toEqual(["b"]);
  });

  it("is cleared, and placing stops, when modeling ends", () => {
    receiveState({}, createEntity({ name: "a" }));
    modeling.select(["a"]);
    modeling.startPlacing({ kind: "box", address: "" });
    receiveState({ active: false }, createEntity({ name: "a" }));
    expect([modeling.selectedNames, modeling.placing]).toEqual([[], null]);
  });
});

it("entities dropped before the scene is ready are placed once it is", () => {
  const drop = { placing: { kind: "box", address: "" }, position: null } as const;
  modeling.drop(drop);
  expect([modeling.takeDrop(), modeling.takeDrop()]).toEqual([drop, null]);
});

describe("commands", () => {
  it("undo and redo are enabled only if there is something to undo or redo", () => {
    receiveState({});
    modeling.undo();
    modeling.redo();
    expect(sentMessages).toEqual([]);
    receiveState({ can_undo: true, can_redo: true });
    modeling.undo();
    modeling.redo();
    expect(sentMessages.map(({ type }) => type)).toEqual(["undo_world", "redo_world"]);
  });

  it("depend on the selection", () => {
    const group = createEntity({ name: "g", shape: null, size: [], parts: ["p", "q"] });
    receiveState({}, createEntity({ name: "a" }), group, createEntity({ name: "sun", kind: "light", shape: null, size: [] }));
    const listAbilities = (...names: string[]): boolean[] => {
      modeling.select(names);
      return [modeling.canScale, modeling.canGroup, modeling.canUngroup];
    };
    expect(listAbilities("a")).toEqual([true, false, false]);
    expect(listAbilities("g")).toEqual([false, false, true]);
    expect(listAbilities("a", "g")).toEqual([false, true, true]);
    expect(listAbilities("a", "sun")).toEqual([false, false, false]);
  });

  it("send complete messages to the server", () => {
    receiveState({}, createEntity({ name: "a" }), createEntity({ name: "b" }));
    modeling.select(["a", "b"]);
    modeling.copy();
    modeling.groupSelected();
    modeling.remove();
    modeling.paste();
    modeling.save(null);
    modeling.change([{ name: "a", static: true }]);
    expect(sentMessages).toEqual([
      { type: "group_entities", names: ["a", "b"], name: "group" },
      { type: "delete_entities", names: ["a", "b"] },
      { type: "copy_entities", names: ["a", "b"], offset: [0.5, 0.5, 0] },
      { type: "save_world", path: null },
      { type: "change_entities", changes: [{ name: "a", pose: null, size: null, new_name: null, static: true, color: null }] },
    ]);
  });
});

describe("the rows of the selection", () => {
  const mapItems = (): Map<string, TreeItem> => {
    const angles = new AngleUnits(openBrowserStorage());
    angles.current = "deg";
    const items = createEntityItems(modeling, angles).flatMap((item) => [item, ...(item.children?.() ?? [])]);
    return new Map(items.map((item) => [item.key, item]));
  };

  it("show common values of several entities, and change them all in one step", () => {
    receiveState({}, createEntity({ name: "a", pose: [1, 2, 0.5, 0, 0, 0] }), createEntity({ name: "b", pose: [1, 5, 0.5, 0, 0, 0] }));
    modeling.select(["a", "b"]);
    expect([mapItems().get("pose/0")?.value, mapItems().get("pose/1")?.value]).toEqual([1, null]);
    mapItems().get("pose/5")?.set?.(90);
    const [message] = sentMessages;
    const poses = message?.type === "change_entities" ? message.changes.map(({ pose }) => pose) : [];
    expect(poses).toEqual([
      [1, 2, 0.5, 0, 0, 1.570796327],
      [1, 5, 0.5, 0, 0, 1.570796327],
    ]);
  });

  it("depend on the kind of entity", () => {
    receiveState({}, createEntity({ name: "c", shape: "cylinder", size: [0.5, 1], color: [1, 0.5, 0, 0.5] }), createEntity({ name: "sun", kind: "light", shape: null, size: [] }));
    modeling.select(["c"]);
    expect([...mapItems().keys()]).toEqual(expect.arrayContaining(["name", "size/1", "static", "color"]));
    mapItems().get("color")?.set?.("#00ff00");
    expect(sentMessages.at(-1)).toMatchObject({ changes: [{ name: "c", color: [0, 1, 0, 0.5] }] });
    modeling.select(["sun"]);
    expect([...mapItems().keys()].filter((key) => /size|static|color/.test(key))).toEqual([]);
  });

  it("format colors as the page does", () => {
    expect(formatHex([1, 0.5, 0, 1])).toBe("#ff8000");
  });
});
