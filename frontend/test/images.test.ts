import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { ImageFrame } from "../src/protocol";
import { ImageCanvas } from "../src/scene/images/image-canvas";

/** A decoder that finishes when the test tells it to. */
let unpacking: ((bitmap: ImageBitmap) => void)[] = [];
let open = 0;
let most = 0;

function bitmap(): ImageBitmap {
  most = Math.max(most, ++open);
  return { width: 3840, height: 2160, close: () => (open -= 1) };
}

function file(): ImageFrame {
  return { kind: "image_frame", width: 0, height: 0, columns: 0, rows: 0, encoding: "file", data: new Uint8Array(4), camera: null, quality: 0 };
}

async function unpacked(): Promise<void> {
  unpacking.shift()?.(bitmap());
  await Promise.resolve();
  await Promise.resolve();
}

beforeEach(() => {
  [unpacking, open, most] = [[], 0, 0];
  const context = { drawImage: () => undefined };
  vi.stubGlobal("document", { createElement: () => ({ width: 0, height: 0, getContext: () => context }) });
  vi.stubGlobal("createImageBitmap", () => new Promise<ImageBitmap>((resolve) => unpacking.push(resolve)));
});
afterEach(() => vi.unstubAllGlobals());

describe("image files", () => {
  it("are decoded one at a time; of those that arrive meanwhile only the newest is", async () => {
    const shown: number[] = [];
    const image = new ImageCanvas();
    for (let i = 0; i < 30; i++) image.show(file(), () => shown.push(i));
    expect(unpacking).toHaveLength(1);
    await unpacked();
    expect(unpacking).toHaveLength(1);
    await unpacked();
    expect(unpacking).toHaveLength(0);
    expect(shown).toEqual([0, 29]);
    expect([open, most]).toEqual([0, 1]);
  });

  it("are not shown after they were removed", async () => {
    const image = new ImageCanvas();
    image.show(file(), () => undefined);
    image.show(file(), () => undefined);
    image.clear();
    await unpacked();
    expect(unpacking).toHaveLength(0);
    expect([image.isEmpty, image.count, open]).toEqual([true, 0, 0]);
  });
});
