import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { ImageFrame } from "../src/protocol";
import { ImageCanvas } from "../src/scene/images/image-canvas";

/** A decoder that finishes when the test tells it to. */
let pendingDecodes: ((createBitmap: ImageBitmap) => void)[] = [];
let openCount = 0;
let maxOpenCount = 0;

function createBitmap(): ImageBitmap {
  maxOpenCount = Math.max(maxOpenCount, ++openCount);
  return { width: 3840, height: 2160, close: () => (openCount -= 1) };
}

function createFileFrame(): ImageFrame {
  return { kind: "image_frame", width: 0, height: 0, columns: 0, rows: 0, encoding: "file", data: new Uint8Array(4), camera: null, quality: 0 };
}

async function finishDecoding(): Promise<void> {
  pendingDecodes.shift()?.(createBitmap());
  await Promise.resolve();
  await Promise.resolve();
}

beforeEach(() => {
  [pendingDecodes, openCount, maxOpenCount] = [[], 0, 0];
  const context = { drawImage: () => undefined };
  vi.stubGlobal("document", { createElement: () => ({ width: 0, height: 0, getContext: () => context }) });
  vi.stubGlobal("createImageBitmap", () => new Promise<ImageBitmap>((resolve) => pendingDecodes.push(resolve)));
});
afterEach(() => vi.unstubAllGlobals());

describe("image files", () => {
  it("are decoded one at a time; of those that arrive meanwhile only the newest is", async () => {
    const shownIndexes: number[] = [];
    const image = new ImageCanvas();
    for (let i = 0; i < 30; i++) image.show(createFileFrame(), () => shownIndexes.push(i));
    expect(pendingDecodes).toHaveLength(1);
    await finishDecoding();
    expect(pendingDecodes).toHaveLength(1);
    await finishDecoding();
    expect(pendingDecodes).toHaveLength(0);
    expect(shownIndexes).toEqual([0, 29]);
    expect([openCount, maxOpenCount]).toEqual([0, 1]);
  });

  it("are not shown after they were removed", async () => {
    const image = new ImageCanvas();
    image.show(createFileFrame(), () => undefined);
    image.show(createFileFrame(), () => undefined);
    image.clear();
    await finishDecoding();
    expect(pendingDecodes).toHaveLength(0);
    expect([image.isEmpty, image.count, openCount]).toEqual([true, 0, 0]);
  });
});
