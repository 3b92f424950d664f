const ADDRESS = /https?:\/\/\S+(?=\s)/;

/** Finds the page's address in the output of `linkwright view`, which comes in pieces. */
export class AddressReader {
  private text = "";

  /** Add a piece; return the address once it is complete. */
  read(piece: string): string | undefined {
    this.text += piece;
    return ADDRESS.exec(this.text)?.[0];
  }
}
