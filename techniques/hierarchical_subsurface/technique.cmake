# Points are surface elements of core/radiosity.
target_link_libraries(technique_hierarchical_subsurface PRIVATE limn::reference)
