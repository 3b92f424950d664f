import { describe, expect, it, vi } from "vitest";
import { unpackTransforms } from "../src/connection/transforms";
import { FrameStore } from "../src/state/frames";
import { packTransforms } from "./messages";

const HERE = [1, 2, 3, 0, 0, 0, 1] as const;
const NOWHERE = [NaN, NaN, NaN, NaN, NaN, NaN, NaN] as const;

function createTransforms(revision: number, poses: readonly (readonly number[])[], ages = poses.map(() => 0)) {
  const result = unpackTransforms(packTransforms(revision, poses, ages));
  if (!result) throw new Error("not a binary frame");
  return result;
}

describe("binary frames", () => {
  it("are unpacked as pack_transforms packs them", () => {
    const { revision, stamp, poses, ages } = createTransforms(7, [HERE, NOWHERE], [0.5, 2]);
    expect([revision, stamp]).toEqual([7, 12.5]);
    expect([...poses.subarray(0, 7)]).toEqual([...HERE]);
    expect([...ages]).toEqual([0.5, 2]);
  });

  it("of another kind or length are refused", () => {
    const bytes = packTransforms(1, [HERE], [0]);
    expect(unpackTransforms(bytes.slice(0, -4))).toBeNull();
    expect(unpackTransforms(new ArrayBuffer(8))).toBeNull();
    new DataView(bytes).setUint32(0, 99, true);
    expect(unpackTransforms(bytes)).toBeNull();
  });
});

describe("the frame store", () => {
  it("stores poses by name and skips frames without one", () => {
    const store = new FrameStore();
    store.setTable({ type: "frame_table", revision: 1, names: ["base", "lost"], parents: [-1, 0] });
    store.setTransforms(createTransforms(1, [HERE, NOWHERE]));
    expect(store.snapshot()).toEqual({ base: { position: [1, 2, 3], orientation: [0, 0, 0, 1] } });
    expect(store.hasPose(store.rowOf("lost"))).toBe(false);
    expect(store.hasPose(store.rowOf("unknown"))).toBe(false);
  });

  it("emits changes only if a pose has changed", () => {
    const store = new FrameStore();
    const [onPoses, onAges] = [vi.fn(), vi.fn()];
    store.setTable({ type: "frame_table", revision: 1, names: ["base", "lost"], parents: [-1, 0] });
    store.setTransforms(createTransforms(1, [HERE, NOWHERE]));
    store.posesChanged.on(onPoses);
    store.agesChanged.on(onAges);
    store.setTransforms(createTransforms(1, [HERE, NOWHERE], [1, 1]));
    expect([onPoses.mock.calls.length, onAges.mock.calls.length]).toEqual([0, 1]);
    store.setTransforms(createTransforms(1, [NOWHERE, NOWHERE]));
    expect(onPoses.mock.calls.length).toBe(1);
  });

  it("keeps poses that arrive before their table and drops those of an old table", () => {
    const store = new FrameStore();
    store.setTransforms(createTransforms(2, [HERE]));
    store.setTable({ type: "frame_table", revision: 2, names: ["base"], parents: [-1] });
    expect(store.hasPose(0)).toBe(true);
    store.setTransforms(createTransforms(1, [NOWHERE]));
    expect(store.hasPose(0)).toBe(true);
  });

  it("transfers poses to a new table by name", () => {
    const store = new FrameStore();
    store.setTable({ type: "frame_table", revision: 1, names: ["base"], parents: [-1] });
    store.setTransforms(createTransforms(1, [HERE]));
    store.setTable({ type: "frame_table", revision: 2, names: ["map", "base"], parents: [-1, 0] });
    expect(Object.keys(store.snapshot())).toEqual(["base"]);
  });
});
