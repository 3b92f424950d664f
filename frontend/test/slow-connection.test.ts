import { expect, it, vi } from "vitest";
import type { DisplayData } from "../src/connection/data";
import { chooseCause } from "../src/panels/over-scene/slow-notice";
import { Signal } from "../src/signal";
import type { DisplayDataStore } from "../src/state/display-data";
import { SlowConnection } from "../src/state/slow-connection";

vi.mock("../src/strings", () => ({ strings: {} }));

function createStore() {
  return { received: new Signal<DisplayData>(), removed: new Signal<{ display: string; key: string | null }>() };
}

function createCloud(step: number): DisplayData {
  const content = { kind: "cloud_points", positions: new Float32Array(3), colors: new Uint8Array(4), translucent: false, pixel: 0, step } as const;
  return { display: "cloud", key: "", frame: "", stamp: 0, pose: null, content };
}

it("reports reduced content and its rate until complete content arrives", () => {
  const data = createStore();
  let now = 0;
  const connection = new SlowConnection(data as unknown as DisplayDataStore, () => now);
  const onChanged = vi.fn();
  connection.changed.on(onChanged);
  data.received.emit(createCloud(1));
  expect(connection.reducedDisplays).toEqual([]);
  expect(onChanged).not.toHaveBeenCalled();
  for (now = 0; now <= 1000; now += 250) data.received.emit(createCloud(8));
  expect(connection.reducedDisplays).toEqual([{ display: "cloud", reduction: { kind: "points", step: 8 }, rate: 4 }]);
  data.received.emit(createCloud(1));
  expect(connection.reducedDisplays).toEqual([]);
});

it("drops displays that are no longer drawn", () => {
  const data = createStore();
  const connection = new SlowConnection(data as unknown as DisplayDataStore, () => 0);
  data.received.emit(createCloud(2));
  expect(connection.reducedDisplays[0]?.rate).toBeNull();
  data.removed.emit({ display: "cloud", key: null });
  expect(connection.reducedDisplays).toEqual([]);
});

it("does not report images with invisible loss", () => {
  const data = createStore();
  const connection = new SlowConnection(data as unknown as DisplayDataStore, () => 0);
  const createImage = (quality: number): DisplayData["content"] => ({
    kind: "image_frame", width: 64, height: 48, columns: 64, rows: 48, encoding: "file", data: new Uint8Array(9), camera: null, quality,
  });
  data.received.emit({ ...createCloud(1), content: createImage(85) });
  expect(connection.reducedDisplays).toEqual([]);
  data.received.emit({ ...createCloud(1), content: createImage(70) });
  expect(connection.reducedDisplays).toHaveLength(1);
});

it("is not blamed for a page that was slow a moment ago", () => {
  expect(chooseCause("page", true, 0)).toBe("page");
  expect(chooseCause("line", true, 0)).toBe("page");
  expect(chooseCause("line", true, 2)).toBe("line");
  expect(chooseCause("program", false, 1)).toBe("program");
});
