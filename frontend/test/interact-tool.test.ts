import { Raycaster, Vector3 } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Drawing } from "../src/scene/displays/drawing";
import type { ScenePointer } from "../src/scene/picking";
import type { Stage } from "../src/scene/stage";
import { InteractTool } from "../src/scene/tools/interact";
import type { ToolContext, ToolEvent } from "../src/scene/tools/tool";
import { OrbitController } from "../src/state/views/orbit";

// The page's texts read the browser's language when they are imported.
vi.mock("../src/strings", () => ({ strings: { views: { mouse: {} } } }));

let pointerTypes: ScenePointer["type"][];
let hoveredKey: string | null;
let acceptsPress: boolean;
let interaction: object;
let dragCount: number;
let tool: InteractTool;

function createEvent(part: Partial<ToolEvent> & Pick<ToolEvent, "type">): ToolEvent {
  const buttons = { isLeftDown: false, isMiddleDown: false, isRightDown: false, button: null };
  return { x: 1, y: 2, dx: 1, dy: 0, wheel: 0, isShiftDown: false, isCtrlDown: false, isAltDown: false, isClick: false, ...buttons, ...part };
}

beforeEach(() => {
  [pointerTypes, hoveredKey, acceptsPress, dragCount] = [[], null, true, 0];
  const drawing = {
    onPointer: ({ type }: ScenePointer) => {
      pointerTypes.push(type);
      return acceptsPress;
    },
  } as unknown as Drawing;
  const stage = {
    isInteractive: true,
    isFocalShapeVisible: false,
    viewport: { size: { width: 100, height: 100 } },
    picker: {
      objectAt: () => hoveredKey && { display: "d", drawing, hit: { key: hoveredKey, distance: 1, point: new Vector3() } },
      rayAt: () => new Raycaster(),
      selectAt: () => undefined,
    },
    setInteraction: (next: object) => {
      interaction = next;
    },
  } as unknown as Stage;
  const view = { controller: new OrbitController(), drag: () => (dragCount += 1), handleWheel: () => undefined };
  const state = { rows: { bool: () => true } };
  const doNothing = (): void => undefined;
  tool = new InteractTool({ stage, session: { view }, state, setHint: doNothing, setCursor: doNothing, finish: doNothing } as unknown as ToolContext);
  tool.activate();
});

describe("the Interact tool", () => {
  it("notifies drawings when the pointer enters and leaves their objects", () => {
    tool.onPointer(createEvent({ type: "move" }));
    hoveredKey = "a";
    tool.onPointer(createEvent({ type: "move" }));
    hoveredKey = "b";
    tool.onPointer(createEvent({ type: "move" }));
    hoveredKey = null;
    tool.onPointer(createEvent({ type: "move" }));
    expect(pointerTypes).toEqual(["enter", "move", "leave", "enter", "move", "leave"]);
  });

  it("keeps an object that accepts the press until the button is released, and hides the others", () => {
    hoveredKey = "a";
    tool.onPointer(createEvent({ type: "down", button: "left", isLeftDown: true }));
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: true });
    hoveredKey = null;
    tool.onPointer(createEvent({ type: "move", isLeftDown: true }));
    tool.onPointer(createEvent({ type: "up", button: "left" }));
    expect(pointerTypes).toEqual(["enter", "down", "move", "up", "leave"]);
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: false });
    expect(dragCount).toBe(0);
  });

  it("moves the camera if the press was not on an object, even while the pointer is over one", () => {
    tool.onPointer(createEvent({ type: "down", button: "left", isLeftDown: true }));
    hoveredKey = "a";
    tool.onPointer(createEvent({ type: "move", isLeftDown: true }));
    expect([pointerTypes, dragCount]).toEqual([[], 1]);
  });

  it("moves the camera if the drawing refuses the press", () => {
    [hoveredKey, acceptsPress] = ["a", false];
    tool.onPointer(createEvent({ type: "down", button: "left", isLeftDown: true }));
    tool.onPointer(createEvent({ type: "move", isLeftDown: true }));
    expect(dragCount).toBe(1);
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: false });
  });

  it("notifies drawings when it is deactivated", () => {
    tool.deactivate();
    expect(interaction).toEqual({ isEnabled: false, hidesOthers: false });
  });
});
