import { PIECE_KIND } from "../protocol";

const HEADER_BYTES = 16;

/** Joins binary frames that arrive in pieces, as `pack_piece` of `page/protocol/message.py` cuts them. */
export class FrameAssembler {
  private frameNumber = 0;
  private frame = new Uint8Array();

  /** Adds a piece; returns the frame that it completes, or null while pieces are missing. */
  add(piece: ArrayBuffer): ArrayBuffer | null {
    const header = new DataView(piece);
    const [number, offset, length] = [4, 8, 12].map((byteOffset) => header.getUint32(byteOffset, true)) as [number, number, number];
    if (offset === 0) [this.frameNumber, this.frame] = [number, new Uint8Array(length)];
    if (number !== this.frameNumber) return null;
    const bytes = new Uint8Array(piece, HEADER_BYTES);
    this.frame.set(bytes, offset);
    if (offset + bytes.length < length) return null;
    const { buffer } = this.frame;
    this.frame = new Uint8Array();
    return buffer;
  }
}

export function isPiece(bytes: ArrayBuffer): boolean {
  return bytes.byteLength >= HEADER_BYTES && new DataView(bytes).getUint32(0, true) === PIECE_KIND;
}
