import { Signal } from "../signal";

/** Loading that is done before is not told. */
const TOLD_AFTER_MS = 500;
/** Reading holds the page up, so that files from here on are told before it begins. */
const LARGE_BYTES = 4_000_000;

/** The progress of loading a mesh file. */
export interface MeshLoad {
  /** The file's, without folders. */
  readonly name: string;
  bytes: number;
  /** All that will come; null where the server does not say. */
  total: number | null;
  stage: "fetching" | "reading";
}

/** Mesh files that take longer than a moment to be there. */
export class MeshProgress {
  readonly changed = new Signal();
  private readonly shown = new Set<MeshLoad>();

  /** The loads to be shown, in the order of their beginnings. */
  get loads(): readonly Readonly<MeshLoad>[] {
    return [...this.shown];
  }

  /** The loading of a file begins; whoever began it tells the rest. */
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
  /** So many bytes are there. */
  came(bytes: number, total: number | null): void;
  /** All are there; resolves when that is to be seen, for reading does not let the page be painted. */
  reads(): Promise<void>;
  /** It is there, or has failed. */
  ended(): void;
}

/** Resolves when the page was painted; a page that nobody sees is not, and goes on. */
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
