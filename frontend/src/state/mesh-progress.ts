import { Signal } from "../signal";

/** Loading that finishes sooner is not reported. */
const TOLD_AFTER_MS = 500;
/** Reading blocks the page, so files from this size on are reported before it begins. */
const LARGE_BYTES = 4_000_000;

/** The progress of loading a mesh file. */
export interface MeshLoad {
  /** The file's, without folders. */
  readonly name: string;
  bytes: number;
  /** The total size; null if the server does not send it. */
  total: number | null;
  stage: "fetching" | "reading";
}

/** Mesh files that take longer than a moment to load. */
export class MeshProgress {
  readonly changed = new Signal();
  private readonly shown = new Set<MeshLoad>();

  /** The loads to be shown, in the order of their beginnings. */
  get loads(): readonly Readonly<MeshLoad>[] {
    return [...this.shown];
  }

  /** Begins the loading of a file; the caller reports its progress. */
  begin(name: string): LoadReport {
    const load: MeshLoad = { name, bytes: 0, total: null, stage: "fetching" };
    const show = (): void => {
      this.shown.add(load);
      this.changed.emit();
    };
    const timer = setTimeout(show, TOLD_AFTER_MS);
    const tell = (): void => {
      if (this.shown.has(load)) this.changed.emit();
    };
    return {
      came: (bytes, total) => {
        Object.assign(load, { bytes, total });
        tell();
      },
      reads: async () => {
        load.stage = "reading";
        if (load.bytes >= LARGE_BYTES) show();
        tell();
        if (this.shown.has(load)) await painted();
      },
      ended: () => {
        clearTimeout(timer);
        if (this.shown.delete(load)) this.changed.emit();
      },
    };
  }
}

/** The reports of a file's loader. */
export interface LoadReport {
  /** Reports the number of bytes received. */
  came(bytes: number, total: number | null): void;
  /** Reports that all bytes are received; resolves when the page shows it, because reading blocks painting. */
  reads(): Promise<void>;
  /** Reports that the file is loaded, or has failed. */
  ended(): void;
}

/** Resolves when the page was painted; a hidden page is not painted, and continues after a while. */
function painted(): Promise<void> {
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
