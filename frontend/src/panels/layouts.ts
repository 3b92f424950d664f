import type { SerializedDockview } from "dockview";
import type { TextStorage } from "../state/storage";

/** An arrangement of panels, and the file that it is kept for. */
export interface Layout {
  file: string;
  arrangement: SerializedDockview;
}

const KEY = "linkwright.layouts.1";
/** Of more files the browser forgets the one that was seen longest ago. */
const MOST = 12;

/** The arrangements of panels that the browser keeps, one for each file. */
export class Layouts {
  constructor(private readonly storage: TextStorage) {}

  /** That of the file that was seen last. */
  get latest(): Layout | null {
    return this.read()[0] ?? null;
  }

  find(file: string): Layout | null {
    return this.read().find((each) => each.file === file) ?? null;
  }

  keep(layout: Layout): void {
    // Read anew each time: another tab may have another file.
    const others = this.read().filter(({ file }) => file !== layout.file);
    this.storage.setItem(KEY, JSON.stringify([layout, ...others].slice(0, MOST)));
  }

  private read(): Layout[] {
    try {
      const kept: unknown = JSON.parse(this.storage.getItem(KEY) ?? "[]");
      return Array.isArray(kept) ? kept.filter(isLayout) : [];
    } catch {
      return [];
    }
  }
}

function isLayout(kept: unknown): kept is Layout {
  const { file, arrangement } = (kept ?? {}) as Partial<Layout>;
  return typeof file === "string" && typeof arrangement === "object";
}
