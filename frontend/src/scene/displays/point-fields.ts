import type { PointFields } from "../../protocol";
import type { DrawingContext } from "./drawing";

/** The fields of selected points, requested from the server on demand. */
export class PointFieldStore {
  private readonly fieldsByPoint = new Map<string, PointFields["fields"] | null>();
  private readonly unsubscribe: () => void;

  constructor(private readonly context: DrawingContext) {
    this.unsubscribe = context.session.connection.on("point_fields", (message) => {
      if (message.display !== context.display.id) return;
      this.fieldsByPoint.set(`${message.key}:${message.index}`, message.fields);
      context.session.selection.changed.emit(context.session.selection.selectedLink);
    });
  }

  /** Returns the fields of a point by name; null until the server has answered. */
  find(cloud: string, index: number): PointFields["fields"] | null {
    const key = `${cloud}:${index}`;
    const fields = this.fieldsByPoint.get(key);
    if (fields !== undefined) return fields;
    this.fieldsByPoint.set(key, null);
    this.context.session.connection.send({ type: "request_point", display: this.context.display.id, key: cloud, index });
    return null;
  }

  /** Drops the fields of a cloud whose points were replaced. */
  forget(cloud: string): void {
    for (const key of this.fieldsByPoint.keys()) if (key.startsWith(`${cloud}:`)) this.fieldsByPoint.delete(key);
  }

  dispose(): void {
    this.unsubscribe();
  }
}
