function n(e,r){return Object.hasOwn(e,r)?e[r]:null}function t(e){return e.replaceAll("_"," ")}export{n as a,t as b};
