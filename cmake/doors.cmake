# Doors: the headers of a room that others may include, as its top folder's README.md lists them. A row of the card's
# table is | `room` | what | `door` `door` | `inner door` |: doors are for everybody, inner doors for the other rooms of
# the folder that the room lies in (of `study/store` for `study/store/rows`).

# Sets `doors` and `inner` to the paths of the headers that the card of ROOT/folder lists.
function(read_doors root folder doors inner)
  set(found_doors)
  set(found_inner)
  if(EXISTS ${root}/${folder}/README.md)
    file(STRINGS ${root}/${folder}/README.md rows ENCODING UTF-8 REGEX "^[|] `[a-z_/]+` [|]")
    foreach(row IN LISTS rows)
      string(REGEX MATCH "^[|] `([a-z_/]+)` [|][^|]*[|]([^|]*)[|]([^|]*)" matched "${row}")
      set(room ${folder}/${CMAKE_MATCH_1})
      set(names_found_doors "${CMAKE_MATCH_2}")
      set(names_found_inner "${CMAKE_MATCH_3}")
      foreach(kind found_doors found_inner)
        string(REGEX MATCHALL "[a-z0-9_]+" names "${names_${kind}}")
        list(TRANSFORM names PREPEND ${room}/)
        list(TRANSFORM names APPEND .h)
        list(APPEND ${kind} ${names})
      endforeach()
    endforeach()
  endif()
  set(${doors} ${found_doors} PARENT_SCOPE)
  set(${inner} ${found_inner} PARENT_SCOPE)
endfunction()
