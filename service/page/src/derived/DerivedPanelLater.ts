// What can be made of a result is loaded after the result.
import { later } from "../ui/later";

export const DerivedPanel = later(() => import("./DerivedPanel").then((loaded) => loaded.DerivedPanel), null);
