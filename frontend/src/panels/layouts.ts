import type { SerializedDockview } from "dockview";
import type { TextStorage } from "../state/storage";

/** An arrangement of panels, the file that it is kept for, and whether it is that of a narrow window. */
export interface Layout {
  file: string;
  narrow: boolean;
  arrangement: SerializedDockview;
}

const KEY = "linkwright.layouts.2";
/** Of more the browser forgets the one that was seen longest ago. */
const MOST = 12;

/** The arrangements of panels that the browser keeps, for each file one of wide and one of narrow windows. */
export class Layouts {
  constructor(private readonly storage: TextStorage) {}

  /** That of the file that was seen last in such a window. */
  latest(narrow: boolean): Layout | null {
    return this.read().find((each) => each.narrow === narrow) ?? null;
  }

  find(file: string, narrow: boolean): Layout | null {
    return this.read().find((each) => each.file === file && each.narrow === narrow) ?? null;
  }

  keep(layout: Layout): void {
    // Read anew each time: another tab may have another file.
    const others = this.read().filter(({ file, narrow }) => file !== layout.file || narrow !== layout.narrow);
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
  const { file, narrow, arrangement } = (kept ?? {}) as Partial<Layout>;
  return typeof file === "string" && typeof narrow === "boolean" && typeof arrangement === "object";
}
