import { CanvasTexture, LinearFilter, LinearMipmapLinearFilter } from "three";

const ATLAS_SIZE_PX = 1024;
const FONT_PX = 44;
const MARGIN_PX = 6;
const CELL_HEIGHT_PX = 60;
const FONT = `600 ${FONT_PX}px "Liberation Sans", "Noto Sans", Arial, "Noto Sans CJK SC", sans-serif`;

/** A character's place in the atlas; sizes relative to the line height. */
export interface Glyph {
  /** u, v of the lower left corner, width and height, 0 to 1. */
  uv: readonly [number, number, number, number];
  width: number;
  advance: number;
}

/** A texture with every character requested so far, white with a dark outline. */
export class GlyphAtlas {
  readonly texture: CanvasTexture;
  private readonly context: CanvasRenderingContext2D;
  private readonly glyphs = new Map<string, Glyph>();
  private nextX = 0;
  private nextY = 0;

  constructor() {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = ATLAS_SIZE_PX;
    const context = canvas.getContext("2d");
    if (!context) throw new Error("This browser does not support the 2D canvas");
    this.context = context;
    this.texture = new CanvasTexture(canvas);
    this.texture.minFilter = LinearMipmapLinearFilter;
    this.texture.magFilter = LinearFilter;
    this.texture.premultiplyAlpha = true;
  }

  /** Returns the glyph of a character, and draws it if it is new; an empty glyph once the atlas is full. */
  glyphOf(character: string): Glyph {
    let glyph = this.glyphs.get(character);
    if (!glyph) {
      glyph = this.draw(character);
      this.glyphs.set(character, glyph);
      this.texture.needsUpdate = true;
    }
    return glyph;
  }

  private draw(character: string): Glyph {
    const { context } = this;
    context.font = FONT;
    const advance = context.measureText(character).width;
    const width = Math.ceil(advance) + 2 * MARGIN_PX;
    if (this.nextX + width > ATLAS_SIZE_PX) {
      this.nextX = 0;
      this.nextY += CELL_HEIGHT_PX;
    }
    if (this.nextY + CELL_HEIGHT_PX > ATLAS_SIZE_PX) return { uv: [0, 0, 0, 0], width: 0, advance: advance / CELL_HEIGHT_PX };
    context.textBaseline = "alphabetic";
    context.lineJoin = "round";
    context.lineWidth = 5;
    context.strokeStyle = "rgba(12, 14, 18, 0.75)";
    context.fillStyle = "white";
    const baseline = this.nextY + CELL_HEIGHT_PX - 16;
    context.strokeText(character, this.nextX + MARGIN_PX, baseline);
    context.fillText(character, this.nextX + MARGIN_PX, baseline);
    const uv = [this.nextX / ATLAS_SIZE_PX, 1 - (this.nextY + CELL_HEIGHT_PX) / ATLAS_SIZE_PX, width / ATLAS_SIZE_PX, CELL_HEIGHT_PX / ATLAS_SIZE_PX] as const;
    this.nextX += width;
    return { uv, width: width / CELL_HEIGHT_PX, advance: advance / CELL_HEIGHT_PX };
  }
}
