import { describe, expect, it } from "vitest";
import { MarkersDrawing } from "../src/scene/displays/markers";
import type { DrawingContext } from "../src/scene/displays/drawing";
import type { MarkerShape } from "../src/protocol";

function createCube(id: string): MarkerShape {
  const marker = { id, namespace: "", frame: "", shape: "cube", pose: [0, 0, 0, 0, 0, 0, 1], scale: [1, 1, 1], color: [1, 0, 0, 1], points: new Float32Array(0), colors: new Float32Array(0), mesh: null };
  return marker as unknown as MarkerShape;
}

function createDrawing(): MarkersDrawing {
  const context = { display: { id: "display-1", rows: { find: () => null } } };
  return new MarkersDrawing(context as unknown as DrawingContext);
}

function send(drawing: MarkersDrawing, markers: MarkerShape[], removedIds: string[] = []): void {
  const content = { kind: "markers_changed", everything: false, removed_ids: removedIds, markers };
  drawing.onDataChanged({ display: "display-1", key: "", content } as unknown as Parameters<MarkersDrawing["onDataChanged"]>[0]);
  drawing.update();
}

describe("a display of markers", () => {
  it("draws nothing before the first marker", () => {
    const drawing = createDrawing();
    drawing.update();
    expect(drawing.root.children).toEqual([]);
    expect(drawing.inspect()).toEqual({ markers: {}, bounds: null });
    drawing.dispose();
  });

  it("draws a cube and removes it", () => {
    const drawing = createDrawing();
    send(drawing, [createCube("a")]);
    expect(drawing.root.children.filter(({ visible }) => visible)).toHaveLength(1);
    expect(drawing.inspect()).toEqual({ markers: { a: "cube" }, bounds: [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]] });
    send(drawing, [], ["a"]);
    expect(drawing.root.children.filter(({ visible }) => visible)).toHaveLength(0);
    drawing.dispose();
  });
});
