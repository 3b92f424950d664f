import { strings } from "../../strings";
import { formatCount, MeshError } from "./mesh-error";

/** NaN and infinity as the dialects of C's printf write them: nan, -nan(ind), inf, 1.#QNAN. */
const NON_FINITE = /^[+-]?(nan|inf|\d\.#(ind|qnan|snan|inf))/i;

/**
 * Reads an ASCII STL: `solid`, then `facet normal`, `outer loop`, three times `vertex`, `endloop`, `endfacet`.
 *
 * @returns x y z of three vertices for each triangle; NaN for a number that is not finite.
 * @throws MeshError with the line of the error.
 */
export function readAsciiStl(text: string): Float32Array {
  return new AsciiStl(text).readTriangles();
}

class AsciiStl {
  private readonly token = /\S+/g;
  private readonly positions: number[] = [];
  private offset = 0;

  constructor(private readonly text: string) {}

  readTriangles(): Float32Array {
    this.token.lastIndex = this.text.toLowerCase().indexOf("solid");
    for (let word = this.readWord(); word !== null; word = this.readWord()) {
      if (word === "solid" || word === "endsolid") this.skipLine();
      else if (word === "facet") this.readFacet();
      else throw this.errorAt(strings.meshes.stl.unexpectedWord(word.slice(0, 40), "'facet'"));
    }
    return new Float32Array(this.positions);
  }

  private readFacet(): void {
    this.expect("normal");
    for (let i = 0; i < 3; i++) this.readNumber();
    this.expect("outer");
    this.expect("loop");
    let count = 0;
    let word = this.readRequired("'vertex'");
    for (; word === "vertex"; word = this.readRequired("'endloop'")) {
      for (let i = 0; i < 3; i++) this.positions.push(this.readNumber());
      count++;
    }
    if (word !== "endloop") throw this.errorAt(strings.meshes.stl.unexpectedWord(word.slice(0, 40), "'vertex'"));
    if (count !== 3) throw this.errorAt(strings.meshes.stl.corners(formatCount(count)));
    this.expect("endfacet");
  }

  private readNumber(): number {
    const word = this.readRequired(strings.meshes.stl.number);
    const value = Number(word);
    if (!Number.isNaN(value) || NON_FINITE.test(word)) return value;
    throw this.errorAt(strings.meshes.stl.unexpectedWord(word.slice(0, 40), strings.meshes.stl.number));
  }

  private expect(word: string): void {
    const text = this.readRequired(`'${word}'`);
    if (text !== word) throw this.errorAt(strings.meshes.stl.unexpectedWord(text.slice(0, 40), `'${word}'`));
  }

  private readRequired(expected: string): string {
    const word = this.readWord();
    if (word !== null) return word;
    this.offset = this.text.trimEnd().length;
    throw this.errorAt(strings.meshes.stl.unexpectedEnd(expected));
  }

  private readWord(): string | null {
    const match = this.token.exec(this.text);
    if (!match) return null;
    this.offset = match.index;
    return match[0].toLowerCase();
  }

  /** Skips the name after `solid`, which may be any text. */
  private skipLine(): void {
    const end = this.text.indexOf("\n", this.offset);
    this.token.lastIndex = end < 0 ? this.text.length : end;
  }

  private errorAt(problem: string): MeshError {
    const line = this.text.slice(0, this.offset).split("\n").length;
    return new MeshError(strings.meshes.stl.line(formatCount(line), problem));
  }
}
