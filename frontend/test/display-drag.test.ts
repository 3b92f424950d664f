import { describe, expect, it } from "vitest";
import { computeDropPart, computeDropPlace, type DropPart } from "../src/panels/displays/display-drag";
import { DisplaysState } from "../src/state/displays";
import { createDisplay, createTree } from "./messages";

const GROUP = "rviz_common/Group";

/** grid, sensors(laser, deep(cloud)), tf */
function createDisplays(): DisplaysState {
  const state = new DisplaysState();
  state.setTree(
    createTree(
      createDisplay({ id: "grid" }),
      createDisplay({ id: "sensors", cls: GROUP }),
      createDisplay({ id: "laser", group: "sensors" }),
      createDisplay({ id: "deep", cls: GROUP, group: "sensors" }),
      createDisplay({ id: "cloud", group: "deep" }),
      createDisplay({ id: "tf" }),
    ),
  );
  return state;
}

function drop(draggedId: string, targetId: string, part: DropPart): unknown {
  const state = createDisplays();
  const [dragged, target] = [state.find(draggedId), state.find(targetId)];
  if (!dragged || !target) throw new Error("no such display");
  return computeDropPlace(state.displays, dragged, target, part);
}

describe("a dropped display", () => {
  it("is inserted before another one, among its siblings", () => {
    expect(drop("tf", "grid", "before")).toEqual({ group: null, nextSibling: "grid" });
    expect(drop("tf", "laser", "before")).toEqual({ group: "sensors", nextSibling: "laser" });
  });

  it("is inserted after another one, which is before the next sibling", () => {
    expect(drop("tf", "grid", "after")).toEqual({ group: null, nextSibling: "sensors" });
    expect(drop("tf", "laser", "after")).toEqual({ group: "sensors", nextSibling: "deep" });
    expect(drop("grid", "tf", "after")).toEqual({ group: null, nextSibling: null });
    expect(drop("sensors", "grid", "after")).toEqual({ group: null, nextSibling: "tf" });
  });

  it("is inserted at the start of a group", () => {
    expect(drop("grid", "sensors", "inside")).toEqual({ group: "sensors", nextSibling: "laser" });
    expect(drop("laser", "sensors", "inside")).toEqual({ group: "sensors", nextSibling: "deep" });
    expect(drop("tf", "grid", "inside")).toBeNull();
  });

  it("is never inserted into itself", () => {
    for (const part of ["before", "inside", "after"] as const) {
      expect(drop("sensors", "sensors", part)).toBeNull();
      expect(drop("sensors", "laser", part)).toBeNull();
      expect(drop("sensors", "cloud", part)).toBeNull();
    }
  });

  it("is inserted according to the pointer's position on the row", () => {
    expect(computeDropPart(2, 20, false)).toBe("before");
    expect(computeDropPart(12, 20, false)).toBe("after");
    expect(computeDropPart(10, 20, true)).toBe("inside");
    expect(computeDropPart(2, 20, true)).toBe("before");
    expect(computeDropPart(19, 20, true)).toBe("after");
  });
});

describe("groups", () => {
  it("disable the displays in them", () => {
    const state = createDisplays();
    const changedIds: string[] = [];
    state.enabledChanged.on((display) => changedIds.push(display.id));
    state.setValue("sensors/Enabled", false, null);
    expect(changedIds).toEqual(["sensors", "laser", "deep", "cloud"]);
    expect(state.displays.filter((display) => !display.isEnabled).map((display) => display.id)).toEqual(changedIds);
    expect(state.find("laser")?.isChecked).toBe(true);
    changedIds.length = 0;
    state.setValue("deep/Enabled", false, null);
    expect(changedIds).toEqual(["deep"]);
    state.setValue("sensors/Enabled", true, null);
    expect(changedIds).toEqual(["deep", "sensors", "laser"]);
  });

  it("contain displays in their order", () => {
    const state = createDisplays();
    expect(state.childrenOf(null).map((display) => display.id)).toEqual(["grid", "sensors", "tf"]);
    expect(state.childrenOf(state.find("sensors") ?? null).map((display) => display.id)).toEqual(["laser", "deep"]);
  });
});
