import type { SerializedDockview } from "dockview";
import type { TextStorage } from "../../storage";
import type { WindowForm } from "./default-layout";

/** An arrangement of panels, with the file and the form of window that it is stored for. */
export interface Layout {
  file: string;
  form: WindowForm;
  arrangement: SerializedDockview;
}

const STORAGE_KEY = "linkwright.layouts.3";
/** The number of stored arrangements; beyond it, the browser drops the least recently used one. */
const MAX_LAYOUTS = 12;

/** The arrangements of panels that the browser stores, one for each file and form of window. */
export class Layouts {
  constructor(private readonly storage: TextStorage) {}

  /** Returns the most recent arrangement for a form of window; its file does not matter. */
  findLatest(form: WindowForm): Layout | null {
    return this.read().find((layout) => layout.form === form) ?? null;
  }

  find(file: string, form: WindowForm): Layout | null {
    return this.read().find((layout) => layout.file === file && layout.form === form) ?? null;
  }

  store(layout: Layout): void {
    // Read again each time: another tab may have stored another arrangement.
    const otherLayouts = this.read().filter(({ file, form }) => file !== layout.file || form !== layout.form);
    this.storage.setItem(STORAGE_KEY, JSON.stringify([layout, ...otherLayouts].slice(0, MAX_LAYOUTS)));
  }

  private read(): Layout[] {
    try {
      const layouts: unknown = JSON.parse(this.storage.getItem(STORAGE_KEY) ?? "[]");
      return Array.isArray(layouts) ? layouts.filter(isLayout) : [];
    } catch {
      return [];
    }
  }
}

function isLayout(value: unknown): value is Layout {
  const { file, form, arrangement } = (value ?? {}) as Partial<Layout>;
  return typeof file === "string" && typeof form === "string" && typeof arrangement === "object";
}
