import { LoadingManager } from "three";
import { strings } from "../../strings";
import { quoteNames } from "./mesh-error";
import type { MeshFiles } from "./mesh-files";

/** A loading manager that tracks the textures a loader requests, and which of them failed. */
export class TextureTracker {
  readonly manager: LoadingManager;
  /** The names of files that could not be loaded. */
  readonly missingNames: string[] = [];
  private pendingCount = 0;
  private resolveWait: (() => void) | null = null;

  constructor(files: MeshFiles) {
    const manager = new LoadingManager();
    manager.setURLModifier((url) => files.addressOf(url));
    const { itemStart, itemEnd, itemError } = manager;
    manager.itemStart = (url): void => {
      this.pendingCount += 1;
      itemStart(url);
    };
    manager.itemEnd = (url): void => {
      this.pendingCount -= 1;
      itemEnd(url);
      if (this.pendingCount === 0) this.resolveWait?.();
    };
    manager.itemError = (url): void => {
      this.missingNames.push(decodeURIComponent(url.split("/").pop() ?? url));
      itemError(url);
    };
    this.manager = manager;
  }

  /** Waits for the textures requested so far; returns a sentence about the missing ones, or null. */
  async settle(): Promise<string | null> {
    if (this.pendingCount > 0) await new Promise<void>((resolve) => (this.resolveWait = resolve));
    if (this.missingNames.length === 0) return null;
    return strings.meshes.missingTextures(quoteNames(this.missingNames));
  }
}
