// What was made of a fit is shown after the fit.
import { later } from "../ui/later";

export const ProductStage = later(() => import("./ProductStage").then((loaded) => loaded.ProductStage), null);
