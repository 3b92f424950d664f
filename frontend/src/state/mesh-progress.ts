import { Signal } from "../signal";

/** Loads that take less time are not shown. */
const SHOWN_AFTER_MS = 500;
/** Files of at least this size are shown before they are read, because reading blocks the page. */
const LARGE_BYTES = 4_000_000;

/** The progress of a mesh file. */
export interface MeshLoad {
  /** The name of the file, without folders. */
  readonly name: string;
  bytes: number;
  /** The total size in bytes; null if the server does not send it. */
  total: number | null;
  stage: "fetching" | "reading";
}

/** The mesh files that take noticeably long to load. */
export class MeshProgress {
  readonly changed = new Signal();
  private readonly shownLoads = new Set<MeshLoad>();

  /** The loads to show, in the order in which they started. */
  get loads(): readonly Readonly<MeshLoad>[] {
    return [...this.shownLoads];
  }

  /** Starts tracking a file, whose loader then reports its progress. */
  startLoad(name: string): LoadReport {
    const load: MeshLoad = { name, bytes: 0, total: null, stage: "fetching" };
    const show = (): void => {
      this.shownLoads.add(load);
      this.changed.emit();
    };
    const timer = setTimeout(show, SHOWN_AFTER_MS);
    const notify = (): void => {
      if (this.shownLoads.has(load)) this.changed.emit();
    };
    return {
      onBytes: (bytes, total) => {
        Object.assign(load, { bytes, total });
        notify();
      },
      startReading: async () => {
        load.stage = "reading";
        if (load.bytes >= LARGE_BYTES) show();
        notify();
        if (this.shownLoads.has(load)) await waitForPaint();
      },
      end: () => {
        clearTimeout(timer);
        if (this.shownLoads.delete(load)) this.changed.emit();
      },
    };
  }
}

/** The functions with which a loader reports the progress of a file. */
export interface LoadReport {
  /** Reports the number of bytes received so far. */
  onBytes(bytes: number, total: number | null): void;
  /** Reports that all bytes are received. Resolves once the page shows that, because reading blocks painting. */
  startReading(): Promise<void>;
  /** Reports that the file is loaded, or failed to load. */
  end(): void;
}

/** Resolves once the page was painted, or after a while, because a hidden page is not painted. */
function waitForPaint(): Promise<void> {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, 200);
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        clearTimeout(timer);
        resolve();
      }),
    );
  });
}
