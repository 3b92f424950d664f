import type { DisplayData } from "../connection/data";
import { Signal } from "../signal";
import type { DisplayDataStore } from "./display-data";

/** The period over which the rate of contents is measured, ms. */
const RATE_WINDOW_MS = 3000;
/** A WebP image at full resolution with a higher quality than this looks like the original. */
const MAX_LOSSY_QUALITY = 70;

/** How the content of a display was reduced. */
export type Reduction =
  | { kind: "points"; step: number }
  | { kind: "image"; columns: number; rows: number; width: number; height: number; quality: number };

export interface ReducedDisplay {
  display: string;
  reduction: Reduction;
  /** The rate of contents, Hz; null if there were too few to measure it. */
  rate: number | null;
}

/** The contents that the server reduces because the connection to this page is slow. */
export class SlowConnection {
  readonly changed = new Signal();
  private readonly reductions = new Map<string, { reduction: Reduction; times: number[] }>();

  constructor(data: DisplayDataStore, private readonly now: () => number = () => performance.now()) {
    data.received.on((content) => this.countContent(content));
    data.removed.on(({ display }) => {
      if (this.reductions.delete(display)) this.changed.emit();
    });
  }

  get reducedDisplays(): ReducedDisplay[] {
    return [...this.reductions].map(([display, { reduction, times }]) => ({ display, reduction, rate: computeRate(times) }));
  }

  private countContent({ display, content }: DisplayData): void {
    const reduction = reductionOf(content);
    if (reduction === null) {
      if (this.reductions.delete(display)) this.changed.emit();
      return;
    }
    const now = this.now();
    const times = [...(this.reductions.get(display)?.times ?? []), now].filter((time) => now - time < RATE_WINDOW_MS);
    this.reductions.set(display, { reduction, times });
    this.changed.emit();
  }
}

function reductionOf(content: DisplayData["content"]): Reduction | null {
  if (content.kind === "cloud_points") return content.step > 1 ? { kind: "points", step: content.step } : null;
  if (content.kind !== "image_frame" || content.quality === 0 || content.quality > MAX_LOSSY_QUALITY) return null;
  const { columns, rows, width, height, quality } = content;
  return { kind: "image", columns, rows, width, height, quality };
}

function computeRate(times: readonly number[]): number | null {
  const [oldestTime, newestTime] = [times[0], times.at(-1)];
  if (oldestTime === undefined || newestTime === undefined || newestTime - oldestTime < RATE_WINDOW_MS / 10) return null;
  return ((times.length - 1) * 1000) / (newestTime - oldestTime);
}
