// What is made to be shown to others is loaded after the result.
import { later } from "../ui/later";

export const Share = later(() => import("./Share").then((loaded) => loaded.Share), null);
