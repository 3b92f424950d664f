import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { formatHex, createEntityItems } from "../src/panels/modeling/entity-items";
import type { ModelingState, PageMessage, WorldEntity } from "../src/protocol";
import { AngleUnits } from "../src/state/angle-unit";
import { Modeling } from "../src/state/modeling/modeling";
import { placementAt, resizeChange, scaledSize, stretchFactors, placeWall } from "../src/state/modeling/shapes";
import { Snapping, snap } from "../src/state/modeling/snapping";
import { openBrowserStorage } from "../src/storage";
import type { TreeItem } from "../src/tree/tree-item";

// The page's texts read the browser's language when they are imported.
vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

let sent: PageMessage[];
let connection: Connection;
let modeling: Modeling;

function entity(part: Partial<WorldEntity> & Pick<WorldEntity, "name">): WorldEntity {
  const size = [1, 1, 1];
  return { kind: "model", pose: [0, 0, 0.5, 0, 0, 0], static: false, shape: "box", size, color: null, address: null, parts: [], ...part };
}

function told(part: Partial<ModelingState>, ...entities: WorldEntity[]): void {
  const state = { available: true, active: true, file: "/w.sdf", unsaved: false, can_undo: false, can_redo: false };
  connection.message.emit({ type: "modeling_state", ...state, ...part, entities });
}

beforeEach(() => {
  sent = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sent.push(message));
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
    expect(snapping.currentSteps(false)).toEqual({ length: 0.5, angle: Math.PI / 2 });
    expect(snapping.currentSteps(true)).toEqual({ length: 0, angle: 0 });
    snapping.isEnabled = false;
    const again = new Snapping(storage);
    expect([again.isEnabled, again.meters, again.degrees]).toEqual([false, 0.5, 90]);
    expect(again.currentSteps(true).length).toBe(0.5);
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
    const wall = placeWall([1, 1], [1, 4]);
    expect(wall).toEqual({ pose: [1, 2.5, 0.5, 0, 0, Math.PI / 2], size: [3, 0.1, 1] });
    expect(placeWall([1, 1], [1, 1])).toBeNull();
  });

  it("scale along their axes, round ones by the axis scaled most, never to zero", () => {
    expect(scaledSize("box", [1, 2, 3], [2, 1, 0.5], 0.1)).toEqual([2, 2, 1.5]);
    expect(scaledSize("cylinder", [0.5, 1], [1, 0.5, 1], 0)).toEqual([0.25, 1]);
    expect(scaledSize("sphere", [0.5], [1, 1, 3], 0)).toEqual([1.5]);
    expect(scaledSize("box", [1, 1, 1], [0, 1, 1], 0.25)).toEqual([0.25, 1, 1]);
    expect(scaledSize("box", [0.33, 1, 1], [1, 2, 1], 0.1)).toEqual([0.33, 2, 1]);
    expect(stretchFactors("cylinder", [0.5, 1], [1, 3])).toEqual([2, 2, 3]);
  });

  it("keep their lowest point in place while they are upright", () => {
    expect(resizeChange(entity({ name: "box" }), [1, 1, 3])).toEqual({ name: "box", size: [1, 1, 3], pose: [0, 0, 1.5, 0, 0, 0] });
    const tilted = entity({ name: "box", pose: [0, 0, 0.5, 0.1, 0, 0] });
    expect(resizeChange(tilted, [1, 1, 3])).toEqual({ name: "box", size: [1, 1, 3] });
  });
});

describe("the selection", () => {
  it("is replaced, or extended and reduced with Shift", () => {
    told({}, entity({ name: "a" }), entity({ name: "b" }));
    modeling.select(["a"]);
    modeling.select(["b"], "toggle");
    expect(modeling.selectedNames).toEqual(["a", "b"]);
    modeling.select(["a"], "toggle");
    expect(modeling.selectedNames).toEqual(["b"]);
  });

  it("contains entities that this page has created, and no removed ones", () => {
    told({}, entity({ name: "a" }));
    modeling.select(["a"]);
    told({}, entity({ name: "a" }), entity({ name: "of another page" }));
    expect(modeling.selectedNames).toEqual(["a"]);
    modeling.add({ kind: "box", address: "" }, placementAt("box", [0, 0]));
    told({ can_undo: true }, entity({ name: "a" }), entity({ name: "box" }));
    expect(modeling.selectedNames).toEqual(["box"]);
    told({ can_redo: true }, entity({ name: "a" }));
    expect(modeling.selectedNames).toEqual([]);
  });

  it("follows an entity that is renamed, unless the server refuses", () => {
    told({}, entity({ name: "a" }));
    modeling.select(["a"]);
    modeling.change([{ name: "a", new_name: "b" }]);
    told({}, entity({ name: "b" }));
    expect(modeling.selectedNames).toEqual(["b"]);
    modeling.change([{ name: "b", new_name: "c" }]);
    connection.message.emit({ type: "simulation_notice", text: "no" });
    told({}, entity({ name: "b" }), entity({ name: "d" }));
    expect(modeling.selectedNames).toEqual(["b"]);
  });

  it("is cleared, and placing stops, when modeling ends", () => {
    told({}, entity({ name: "a" }));
    modeling.select(["a"]);
    modeling.startPlacing({ kind: "box", address: "" });
    told({ active: false }, entity({ name: "a" }));
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
    told({});
    modeling.undo();
    modeling.redo();
    expect(sent).toEqual([]);
    told({ can_undo: true, can_redo: true });
    modeling.undo();
    modeling.redo();
    expect(sent.map(({ type }) => type)).toEqual(["undo_world", "redo_world"]);
  });

  it("depend on the selection", () => {
    const grouped = entity({ name: "g", shape: null, size: [], parts: ["p", "q"] });
    told({}, entity({ name: "a" }), grouped, entity({ name: "sun", kind: "light", shape: null, size: [] }));
    const can = (...names: string[]): boolean[] => {
      modeling.select(names);
      return [modeling.canScale, modeling.canGroup, modeling.canUngroup];
    };
    expect(can("a")).toEqual([true, false, false]);
    expect(can("g")).toEqual([false, false, true]);
    expect(can("a", "g")).toEqual([false, true, true]);
    expect(can("a", "sun")).toEqual([false, false, false]);
  });

  it("send complete messages to the server", () => {
    told({}, entity({ name: "a" }), entity({ name: "b" }));
    modeling.select(["a", "b"]);
    modeling.copy();
    modeling.groupSelected();
    modeling.remove();
    modeling.paste();
    modeling.save(null);
    modeling.change([{ name: "a", static: true }]);
    expect(sent).toEqual([
      { type: "group_entities", names: ["a", "b"], name: "group" },
      { type: "delete_entities", names: ["a", "b"] },
      { type: "copy_entities", names: ["a", "b"], offset: [0.5, 0.5, 0] },
      { type: "save_world", path: null },
      { type: "change_entities", changes: [{ name: "a", pose: null, size: null, new_name: null, static: true, color: null }] },
    ]);
  });
});

describe("the rows of the selection", () => {
  const items = (): Map<string, TreeItem> => {
    const angles = new AngleUnits(openBrowserStorage());
    angles.current = "deg";
    const all = createEntityItems(modeling, angles).flatMap((item) => [item, ...(item.children?.() ?? [])]);
    return new Map(all.map((item) => [item.key, item]));
  };

  it("show common values of several entities, and change them all in one step", () => {
    told({}, entity({ name: "a", pose: [1, 2, 0.5, 0, 0, 0] }), entity({ name: "b", pose: [1, 5, 0.5, 0, 0, 0] }));
    modeling.select(["a", "b"]);
    expect([items().get("pose/0")?.value, items().get("pose/1")?.value]).toEqual([1, null]);
    items().get("pose/5")?.set?.(90);
    const [message] = sent;
    const poses = message?.type === "change_entities" ? message.changes.map(({ pose }) => pose) : [];
    expect(poses).toEqual([
      [1, 2, 0.5, 0, 0, 1.570796327],
      [1, 5, 0.5, 0, 0, 1.570796327],
    ]);
  });

  it("depend on the kind of entity", () => {
    told({}, entity({ name: "c", shape: "cylinder", size: [0.5, 1], color: [1, 0.5, 0, 0.5] }), entity({ name: "sun", kind: "light", shape: null, size: [] }));
    modeling.select(["c"]);
    expect([...items().keys()]).toEqual(expect.arrayContaining(["name", "size/1", "static", "color"]));
    items().get("color")?.set?.("#00ff00");
    expect(sent.at(-1)).toMatchObject({ changes: [{ name: "c", color: [0, 1, 0, 0.5] }] });
    modeling.select(["sun"]);
    expect([...items().keys()].filter((key) => /size|static|color/.test(key))).toEqual([]);
  });

  it("format colors as the page does", () => {
    expect(formatHex([1, 0.5, 0, 1])).toBe("#ff8000");
  });
});
