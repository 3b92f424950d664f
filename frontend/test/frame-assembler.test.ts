import { describe, expect, it } from "vitest";
import { isPiece, FrameAssembler } from "../src/connection/frame-assembler";

function createPiece(number: number, offset: number, length: number, bytes: number[]): ArrayBuffer {
  const { buffer } = new Uint8Array([...new Uint8Array(new Uint32Array([4, number, offset, length]).buffer), ...bytes]);
  return buffer;
}

describe("pieces", () => {
  it("are assembled into the original frame", () => {
    const assembler = new FrameAssembler();
    expect(assembler.add(createPiece(1, 0, 5, [1, 2]))).toBeNull();
    expect(assembler.add(createPiece(1, 2, 5, [3, 4]))).toBeNull();
    expect(assembler.add(createPiece(1, 4, 5, [5]))).toEqual(new Uint8Array([1, 2, 3, 4, 5]).buffer);
  });

  it("of an abandoned frame are dropped", () => {
    const assembler = new FrameAssembler();
    assembler.add(createPiece(1, 0, 4, [1, 2]));
    expect(assembler.add(createPiece(2, 0, 2, [7]))).toBeNull();
    expect(assembler.add(createPiece(1, 2, 4, [3, 4]))).toBeNull();
    expect(assembler.add(createPiece(2, 1, 2, [8]))).toEqual(new Uint8Array([7, 8]).buffer);
  });

  it("are distinguished from other frames", () => {
    expect(isPiece(createPiece(1, 0, 1, [1]))).toBe(true);
    expect(isPiece(new Uint32Array([2, 0, 0, 0]).buffer)).toBe(false);
    expect(isPiece(new ArrayBuffer(3))).toBe(false);
  });
});
