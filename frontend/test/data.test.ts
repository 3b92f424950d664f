import { expect, test } from "vitest";
import { unpackData } from "../src/connection/data";

/** Packs a frame like `pack_data` of page/protocol/message.py. */
function packData(header: object, arrays: readonly ArrayBufferView[]): ArrayBuffer {
  const pad = (length: number): number => Math.ceil(length / 8) * 8;
  const text = new TextEncoder().encode(JSON.stringify(header));
  const start = pad(16 + text.length);
  const bytes = new Uint8Array(start + arrays.reduce((sum, array) => sum + pad(array.byteLength), 0));
  const view = new DataView(bytes.buffer);
  view.setUint32(0, 2, true);
  view.setUint32(4, text.length, true);
  bytes.set(text, 16);
  let offset = start;
  for (const array of arrays) {
    bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), offset);
    offset += pad(array.byteLength);
  }
  return bytes.buffer;
}

test("content is decoded with its arrays in place of references", () => {
  const content = { kind: "point_marks", positions: { $: ["f4", 0, 3] }, colors: [{ $: ["u1", 16, 2] }] };
  const header = { display: "display-1", key: "", frame: "", stamp: 1.5, pose: null, content };
  const data = unpackData(packData(header, [new Float32Array([1, 2, 3]), new Uint8Array([7, 8])]));
  expect(data).toEqual({
    ...header,
    content: { kind: "point_marks", positions: new Float32Array([1, 2, 3]), colors: [new Uint8Array([7, 8])] },
  });
});

test("arrays are restored in objects within lists, and lists of numbers stay unchanged", () => {
  const marker = { id: "a/1", pose: [1, 2, 3], points: { $: ["f4", 0, 3] }, mesh: null };
  const secondMarker = { ...marker, id: "a/2", points: { $: ["f4", 16, 1] }, mesh: { data: { $: ["u1", 0, 0] } } };
  const header = { display: "d", key: "k", frame: "", stamp: 0, pose: [0, 0, 0, 0, 0, 0, 1], content: { markers: [marker, secondMarker] } };
  const data = unpackData(packData(header, [new Float32Array([4, 5, 6]), new Float32Array([-7])]));
  const markers = [
    { ...marker, points: new Float32Array([4, 5, 6]) },
    { ...secondMarker, points: new Float32Array([-7]), mesh: { data: new Uint8Array(0) } },
  ];
  expect(data).toEqual({ ...header, content: { markers } });
});

test("frames of other kinds are not taken for display data", () => {
  expect(unpackData(new ArrayBuffer(3))).toBeNull();
  expect(unpackData(new ArrayBuffer(64))).toBeNull();
});
