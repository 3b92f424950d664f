import type { Connection } from "../connection/connection";
import type { DisplayData } from "../connection/data";
import { Signal } from "../signal";

/** The newest contents of every display, by key. */
export class DisplayDataStore {
  readonly received = new Signal<DisplayData>();
  /** Contents were removed; `key` is null if all contents of the display were. */
  readonly removed = new Signal<{ display: string; key: string | null }>();
  private readonly contents = new Map<string, Map<string, DisplayData>>();

  constructor(connection: Connection) {
    connection.data.on((data) => this.add(data));
    connection.on("display_forgotten", ({ display, key }) => this.remove(display, key));
    // After a restart, the server sends the contents that are still drawn again.
    connection.on("hello", () => {
      for (const display of [...this.contents.keys()]) this.remove(display, null);
    });
  }

  /** Returns the contents of a display. */
  contentsOf(display: string): Iterable<DisplayData> {
    return this.contents.get(display)?.values() ?? [];
  }

  private add(data: DisplayData): void {
    let contents = this.contents.get(data.display);
    if (!contents) this.contents.set(data.display, (contents = new Map<string, DisplayData>()));
    contents.set(data.key, data);
    this.received.emit(data);
  }

  private remove(display: string, key: string | null): void {
    if (key === null) this.contents.delete(display);
    else this.contents.get(display)?.delete(key);
    this.removed.emit({ display, key });
  }
}
