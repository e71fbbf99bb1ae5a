// One draft in this browser's own database. A browser may forbid that, as it does in private windows: then nothing is
// kept, and the page works on. A draft has an id: what an older one of another window says is not taken for the newer's.

export interface StoredPicture {
  readonly name: string;
  readonly file: Blob;
  readonly shown: Blob;
}

/** Whatever else the draft consists of: values that are cloned, files among them. */
export type StoredRest = Readonly<Record<string, unknown>>;

export interface StoredDraft {
  readonly picture: StoredPicture;
  readonly rest: StoredRest;
}

const DATABASE = "maquette";
const STORE = "draft";

let opened: Promise<IDBDatabase> | null = null;

export async function storedDraft(): Promise<(StoredDraft & { readonly id: string }) | null> {
  return inStore("readonly", async (store) => {
    const [id, picture, rest] = await Promise.all(["id", "picture", "rest"].map((key) => answer(store.get(key))));
    return id && picture && rest ? ({ id, picture, rest } as StoredDraft & { id: string }) : null;
  });
}

/** Put a draft in the place of whichever is there. */
export async function storeDraft(id: string, { picture, rest }: StoredDraft): Promise<void> {
  await inStore("readwrite", (store) => {
    store.put(id, "id");
    store.put(picture, "picture");
    store.put(rest, "rest");
  });
}

/** What was said of the picture, if this draft is the one that is kept. */
export async function storeRest(id: string, rest: StoredRest): Promise<void> {
  await inStore("readwrite", async (store) => {
    if ((await answer(store.get("id"))) === id) store.put(rest, "rest");
  });
}

export async function eraseStored(id: string): Promise<void> {
  await inStore("readwrite", async (store) => {
    if ((await answer(store.get("id"))) === id) store.clear();
  });
}

async function inStore<T>(mode: IDBTransactionMode, work: (store: IDBObjectStore) => T | Promise<T>): Promise<T | null> {
  try {
    const transaction = (await database()).transaction(STORE, mode);
    const done = new Promise<void>((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = transaction.onerror = () => reject(transaction.error);
    });
    const [result] = await Promise.all([work(transaction.objectStore(STORE)), done]);
    return result;
  } catch {
    return null;
  }
}

function database(): Promise<IDBDatabase> {
  opened ??= new Promise((resolve, reject) => {
    const asked = indexedDB.open(DATABASE, 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore(STORE);
    asked.onsuccess = () => resolve(asked.result);
    asked.onerror = () => reject(asked.error);
  });
  return opened;
}

function answer(request: IDBRequest): Promise<unknown> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}
