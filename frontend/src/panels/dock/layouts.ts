import type { SerializedDockview } from "dockview";
import type { TextStorage } from "../../storage";
import type { Form } from "./default-layout";

/** An arrangement of panels, the file that it is kept for, and the form of the window that it is of. */
export interface Layout {
  file: string;
  form: Form;
  arrangement: SerializedDockview;
}

const KEY = "linkwright.layouts.3";
/** Of more the browser forgets the one that was seen longest ago. */
const MOST = 12;

/** The arrangements of panels that the browser keeps, for each file one of each form of window. */
export class Layouts {
  constructor(private readonly storage: TextStorage) {}

  /** The arrangement of the file that was seen last in a window of a form. */
  latest(form: Form): Layout | null {
    return this.read().find((each) => each.form === form) ?? null;
  }

  find(file: string, form: Form): Layout | null {
    return this.read().find((each) => each.file === file && each.form === form) ?? null;
  }

  keep(layout: Layout): void {
    // Read again each time: another tab may have another file.
    const others = this.read().filter(({ file, form }) => file !== layout.file || form !== layout.form);
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
  const { file, form, arrangement } = (kept ?? {}) as Partial<Layout>;
  return typeof file === "string" && typeof form === "string" && typeof arrangement === "object";
}
