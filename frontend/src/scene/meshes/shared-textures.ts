import type { Texture } from "three";
import { loadTexture } from "../materials";

interface Shared {
  readonly texture: Promise<Texture>;
  users: number;
}

/** Textures by address, each on the GPU only once however many shapes use it. */
export class SharedTextures {
  private readonly textures = new Map<string, Shared>();

  constructor(private readonly load: (url: string) => Promise<Texture> = loadTexture) {}

  /** Returns the texture at `url`. The caller must release it with `release`, even if it cannot be loaded. */
  acquire(url: string): Promise<Texture> {
    let entry = this.textures.get(url);
    if (!entry) this.textures.set(url, (entry = { texture: this.load(url), users: 0 }));
    entry.users++;
    return entry.texture;
  }

  release(url: string): void {
    const entry = this.textures.get(url);
    if (!entry || --entry.users > 0) return;
    this.textures.delete(url);
    entry.texture.then(
      (texture) => texture.dispose(),
      () => undefined,
    );
  }
}
