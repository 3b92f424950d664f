import { CanvasTexture, LinearFilter, NoColorSpace, Sprite, SpriteMaterial } from "three";

const FONT_PX = 48;
const LINE_HEIGHT_PX = 58;
const PADDING_PX = 6;
/** The outline around letters, in a contrasting color so that they are legible on any background. */
const OUTLINE_WIDTH_PX = 6;
const OUTLINE_COLORS = { dark: "rgba(12, 14, 18, 0.8)", light: "rgba(255, 255, 255, 0.85)" };
const LIGHT_LUMINANCE = 0.4;
/** The maximum width and height of a texture, px; larger ones would exceed the limit of GPUs. */
const MAX_TEXTURE_PX = 4096;

/** Returns a text that faces the camera, centered at the origin; `height` is the height of a line, m. */
export function createTextSprite(text: string, height: number, color: readonly number[]): Sprite {
  const [r = 1, g = 1, b = 1, a = 1] = color;
  const lines = text.split("\n");
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  const font = `${FONT_PX}px "Liberation Sans", Arial, "Noto Sans CJK SC", sans-serif`;
  if (context) context.font = font;
  const width = Math.max(1, ...lines.map((line) => context?.measureText(line).width ?? 1));
  canvas.width = Math.min(MAX_TEXTURE_PX, Math.ceil(width) + 2 * PADDING_PX);
  canvas.height = Math.min(MAX_TEXTURE_PX, lines.length * LINE_HEIGHT_PX + 2 * PADDING_PX);
  if (context) {
    context.font = font;
    context.fillStyle = `rgb(${[r, g, b].map((channel) => Math.round(255 * channel)).join(" ")})`;
    context.strokeStyle = 0.3 * r + 0.59 * g + 0.11 * b > LIGHT_LUMINANCE ? OUTLINE_COLORS.dark : OUTLINE_COLORS.light;
    context.lineWidth = OUTLINE_WIDTH_PX;
    context.lineJoin = "round";
    context.textBaseline = "middle";
    context.textAlign = "center";
    for (const [row, line] of lines.entries()) {
      const position = [canvas.width / 2, PADDING_PX + (row + 0.5) * LINE_HEIGHT_PX] as const;
      context.strokeText(line, ...position);
      context.fillText(line, ...position);
    }
  }
  const map = new CanvasTexture(canvas);
  map.colorSpace = NoColorSpace;
  map.minFilter = LinearFilter;
  map.generateMipmaps = false;
  const material = new SpriteMaterial({ map, transparent: true, opacity: a, depthWrite: false });
  const sprite = new Sprite(material);
  const scale = height / FONT_PX;
  sprite.scale.set(canvas.width * scale, canvas.height * scale, 1);
  return sprite;
}
