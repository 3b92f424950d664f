import { h } from "../../dom";

/** Our own drawings of turtles, seen from above, heading along x; they are as long as turtlesim's, 45 pixels. */
interface Turtle {
  skin: string;
  shell: string;
  /** The lines on the shell. */
  pattern: (context: CanvasRenderingContext2D) => void;
  /** The half width of the shell; its half length is 14. */
  breadth: number;
}

const OUTLINE = "#1c2b21";
const SHELL_LENGTH = 14;

function drawLine(context: CanvasRenderingContext2D, ...points: readonly (readonly [number, number])[]): void {
  context.beginPath();
  points.forEach(([x, y], index) => (index === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
}

function drawPlates(context: CanvasRenderingContext2D): void {
  drawLine(context, [-6, 0], [-3, 5], [3, 5], [6, 0], [3, -5], [-3, -5], [-6, 0]);
  for (const [x, y] of [[-6, 0], [-3, 5], [3, 5], [6, 0], [3, -5], [-3, -5]] as const) drawLine(context, [x, y], [x * 1.9, y * 1.9]);
}

function drawRings(context: CanvasRenderingContext2D): void {
  for (const share of [0.35, 0.68]) {
    context.beginPath();
    context.ellipse(0, 0, SHELL_LENGTH * share, 11 * share, 0, 0, 2 * Math.PI);
    context.stroke();
  }
}

function drawRidges(context: CanvasRenderingContext2D): void {
  for (const y of [-5, 0, 5]) drawLine(context, [-11, y * 0.8], [0, y * 1.2], [11, y * 0.8]);
}

function drawStripes(context: CanvasRenderingContext2D): void {
  for (const x of [-8, -3, 2, 7]) drawLine(context, [x - 1.5, -9], [x + 1.5, 0], [x - 1.5, 9]);
}

function drawSpiral(context: CanvasRenderingContext2D): void {
  const points = Array.from({ length: 49 }, (_, i): [number, number] => {
    const [angle, radius] = [(i / 48) * 5 * Math.PI, (i / 48) * 9];
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
  drawLine(context, ...points);
}

function drawStar(context: CanvasRenderingContext2D): void {
  const corners = Array.from({ length: 11 }, (_, i): [number, number] => {
    const [angle, radius] = [(i * Math.PI) / 5, i % 2 === 0 ? 9 : 4];
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
  drawLine(context, ...corners);
}

/** As many as `SHAPE_COUNT` of turtlesim's node. */
const TURTLES: readonly Turtle[] = [
  { skin: "#8ccf6e", shell: "#3f8f4f", pattern: drawPlates, breadth: 12 },
  { skin: "#f2c879", shell: "#b86f2c", pattern: drawRings, breadth: 13 },
  { skin: "#9adbc6", shell: "#1f7a78", pattern: drawRidges, breadth: 11 },
  { skin: "#e9a1a1", shell: "#a03c4d", pattern: drawStripes, breadth: 12.5 },
  { skin: "#d9d36a", shell: "#7b7a20", pattern: drawSpiral, breadth: 12 },
  { skin: "#c7b5ee", shell: "#5f4a94", pattern: drawStar, breadth: 13.5 },
];

/** The size of a drawing in pixels of the world, and the pixels of the canvas in one of these. */
const DRAWING_SIZE = 60;
const SCALE = 4;

/** Creates a canvas with a turtle in its middle, heading along x. */
export function createTurtle(shape: number): HTMLElement {
  const canvas = h("canvas", { class: "turtle" });
  canvas.width = canvas.height = DRAWING_SIZE * SCALE;
  const context = canvas.getContext("2d");
  if (context) {
    context.scale(SCALE, SCALE);
    context.translate(DRAWING_SIZE / 2, DRAWING_SIZE / 2);
    drawTurtle(context, shape);
  }
  return canvas;
}

function drawTurtle(context: CanvasRenderingContext2D, shape: number): void {
  const turtle = TURTLES[shape % TURTLES.length];
  if (!turtle) return;
  const { skin, shell, pattern, breadth } = turtle;
  context.lineWidth = 1.2;
  context.lineJoin = "round";
  context.strokeStyle = OUTLINE;
  context.fillStyle = skin;
  drawTail(context);
  for (const side of [-1, 1]) {
    drawFlipper(context, 8, side * breadth * 0.75, side * 0.7, 10);
    drawFlipper(context, -9, side * breadth * 0.7, side * 2.4, 7);
  }
  drawHead(context);
  context.fillStyle = shell;
  context.beginPath();
  context.ellipse(0, 0, SHELL_LENGTH, breadth, 0, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
  context.save();
  context.clip();
  context.strokeStyle = skin;
  context.globalAlpha = 0.75;
  pattern(context);
  context.restore();
}

function drawFlipper(context: CanvasRenderingContext2D, x: number, y: number, angle: number, length: number): void {
  context.beginPath();
  context.ellipse(x + 0.5 * length * Math.cos(angle), y + 0.5 * length * Math.sin(angle), length * 0.75, 3.4, angle, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
}

function drawTail(context: CanvasRenderingContext2D): void {
  context.beginPath();
  context.moveTo(-12, -2.5);
  context.lineTo(-20, 0);
  context.lineTo(-12, 2.5);
  context.fill();
  context.stroke();
}

function drawHead(context: CanvasRenderingContext2D): void {
  context.beginPath();
  context.ellipse(17, 0, 6.5, 5, 0, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
  context.fillStyle = OUTLINE;
  for (const side of [-1, 1]) {
    context.beginPath();
    context.arc(19, side * 2.4, 1.1, 0, 2 * Math.PI);
    context.fill();
  }
}
