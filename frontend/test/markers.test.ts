import { describe, expect, it } from "vitest";
import { MarkersDrawing } from "../src/scene/displays/markers";
import type { DrawingContext } from "../src/scene/displays/drawing";
import type { MarkerShape } from "../src/protocol";

function cube(id: string): MarkerShape {
  const marker = { id, namespace: "", frame: "", shape: "cube", pose: [0, 0, 0, 0, 0, 0, 1], scale: [1, 1, 1], color: [1, 0, 0, 1], points: new Float32Array(0), colors: new Float32Array(0), mesh: null };
  return marker as unknown as MarkerShape;
}

function drawing(): MarkersDrawing {
  const context = { display: { id: "display-1", rows: { find: () => null } } };
  return new MarkersDrawing(context as unknown as DrawingContext);
}

function send(to: MarkersDrawing, markers: MarkerShape[], gone: string[] = []): void {
  const content = { kind: "markers_changed", everything: false, gone, markers };
  to.onDataChanged({ display: "display-1", key: "", content } as unknown as Parameters<MarkersDrawing["onDataChanged"]>[0]);
  to.update();
}

describe("a display of markers", () => {
  it("draws nothing before the first marker", () => {
    const empty = drawing();
    empty.update();
    expect(empty.root.children).toEqual([]);
    expect(empty.inspect()).toEqual({ markers: {}, bounds: null });
    empty.dispose();
  });

  it("draws a cube and removes it", () => {
    const one = drawing();
    send(one, [cube("a")]);
    expect(one.root.children.filter(({ visible }) => visible)).toHaveLength(1);
    expect(one.inspect()).toEqual({ markers: { a: "cube" }, bounds: [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]] });
    send(one, [], ["a"]);
    expect(one.root.children.filter(({ visible }) => visible)).toHaveLength(0);
    one.dispose();
  });
});
