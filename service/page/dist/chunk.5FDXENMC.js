function r({width:e,height:n}){return`${e} \xD7 ${n}`}export{r as a};
