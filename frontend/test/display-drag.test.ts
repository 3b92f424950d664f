import { describe, expect, it } from "vitest";
import { dropPart, dropPlace, type DropPart } from "../src/panels/displays/display-drag";
import { DisplaysState } from "../src/state/displays";
import { display, tree } from "./messages";

const GROUP = "rviz_common/Group";

/** grid, sensors(laser, deep(cloud)), tf */
function displays(): DisplaysState {
  const state = new DisplaysState();
  state.setTree(
    tree(
      display({ id: "grid" }),
      display({ id: "sensors", cls: GROUP }),
      display({ id: "laser", group: "sensors" }),
      display({ id: "deep", cls: GROUP, group: "sensors" }),
      display({ id: "cloud", group: "deep" }),
      display({ id: "tf" }),
    ),
  );
  return state;
}

function drop(dragged: string, target: string, part: DropPart): unknown {
  const state = displays();
  const [from, to] = [state.find(dragged), state.find(target)];
  if (!from || !to) throw new Error("no such display");
  return dropPlace(state.displays, from, to, part);
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
    expect(dropPart(2, 20, false)).toBe("before");
    expect(dropPart(12, 20, false)).toBe("after");
    expect(dropPart(10, 20, true)).toBe("inside");
    expect(dropPart(2, 20, true)).toBe("before");
    expect(dropPart(19, 20, true)).toBe("after");
  });
});

describe("groups", () => {
  it("disable the displays in them", () => {
    const state = displays();
    const told: string[] = [];
    state.enabledChanged.on((each) => told.push(each.id));
    state.setValue("sensors/Enabled", false, null);
    expect(told).toEqual(["sensors", "laser", "deep", "cloud"]);
    expect(state.displays.filter((each) => !each.isEnabled).map((each) => each.id)).toEqual(told);
    expect(state.find("laser")?.isChecked).toBe(true);
    told.length = 0;
    state.setValue("deep/Enabled", false, null);
    expect(told).toEqual(["deep"]);
    state.setValue("sensors/Enabled", true, null);
    expect(told).toEqual(["deep", "sensors", "laser"]);
  });

  it("contain displays in their order", () => {
    const state = displays();
    expect(state.childrenOf(null).map((each) => each.id)).toEqual(["grid", "sensors", "tf"]);
    expect(state.childrenOf(state.find("sensors") ?? null).map((each) => each.id)).toEqual(["laser", "deep"]);
  });
});
