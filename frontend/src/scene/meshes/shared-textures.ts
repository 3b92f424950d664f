import type { Texture } from "three";
import { loadTexture } from "../materials";

interface Shared {
  readonly texture: Promise<Texture>;
  users: number;
}

/** Textures by address, each on the GPU only once however many shapes use it. */
export class SharedTextures {
  private readonly shared = new Map<string, Shared>();

  constructor(private readonly load: (url: string) => Promise<Texture> = loadTexture) {}

  /** Returns the texture at `url`. The caller must release it with `release`, even if it cannot be loaded. */
  acquire(url: string): Promise<Texture> {
    let known = this.shared.get(url);
    if (!known) this.shared.set(url, (known = { texture: this.load(url), users: 0 }));
    known.users++;
    return known.texture;
  }

  release(url: string): void {
    const known = this.shared.get(url);
    if (!known || --known.users > 0) return;
    this.shared.delete(url);
    known.texture.then(
      (texture) => texture.dispose(),
      () => undefined,
    );
  }
}
