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

let told: ScenePointer["type"][];
let under: string | null;
let takes: boolean;
let interaction: object;
let dragged: number;
let tool: InteractTool;

function event(part: Partial<ToolEvent> & Pick<ToolEvent, "type">): ToolEvent {
  const buttons = { left: false, middle: false, right: false, button: null };
  return { x: 1, y: 2, dx: 1, dy: 0, wheel: 0, shift: false, ctrl: false, alt: false, click: false, ...buttons, ...part };
}

beforeEach(() => {
  [told, under, takes, dragged] = [[], null, true, 0];
  const drawing = {
    onPointer: ({ type }: ScenePointer) => {
      told.push(type);
      return takes;
    },
  } as unknown as Drawing;
  const stage = {
    isInteractive: true,
    isFocalShapeVisible: false,
    viewport: { size: { width: 100, height: 100 } },
    picker: {
      objectAt: () => under && { display: "d", drawing, hit: { key: under, distance: 1, point: new Vector3() } },
      rayAt: () => new Raycaster(),
      selectAt: () => undefined,
    },
    setInteraction: (next: object) => {
      interaction = next;
    },
  } as unknown as Stage;
  const view = { controller: new OrbitController(), drag: () => (dragged += 1), wheel: () => undefined };
  const state = { rows: { bool: () => true } };
  const nothing = (): void => undefined;
  tool = new InteractTool({ stage, session: { view }, state, setHint: nothing, setCursor: nothing, finish: nothing } as unknown as ToolContext);
  tool.activate();
});

describe("the Interact tool", () => {
  it("notifies drawings when the pointer enters and leaves their objects", () => {
    tool.onPointer(event({ type: "move" }));
    under = "a";
    tool.onPointer(event({ type: "move" }));
    under = "b";
    tool.onPointer(event({ type: "move" }));
    under = null;
    tool.onPointer(event({ type: "move" }));
    expect(told).toEqual(["enter", "move", "leave", "enter", "move", "leave"]);
  });

  it("keeps an object that accepts the press until the button is released, and hides the others", () => {
    under = "a";
    tool.onPointer(event({ type: "down", button: "left", left: true }));
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: true });
    under = null;
    tool.onPointer(event({ type: "move", left: true }));
    tool.onPointer(event({ type: "up", button: "left" }));
    expect(told).toEqual(["enter", "down", "move", "up", "leave"]);
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: false });
    expect(dragged).toBe(0);
  });

  it("moves the camera if the press was not on an object, even while the pointer is over one", () => {
    tool.onPointer(event({ type: "down", button: "left", left: true }));
    under = "a";
    tool.onPointer(event({ type: "move", left: true }));
    expect([told, dragged]).toEqual([[], 1]);
  });

  it("moves the camera if the drawing refuses the press", () => {
    [under, takes] = ["a", false];
    tool.onPointer(event({ type: "down", button: "left", left: true }));
    tool.onPointer(event({ type: "move", left: true }));
    expect(dragged).toBe(1);
    expect(interaction).toEqual({ isEnabled: true, hidesOthers: false });
  });

  it("notifies drawings when it is deactivated", () => {
    tool.deactivate();
    expect(interaction).toEqual({ isEnabled: false, hidesOthers: false });
  });
});
