; What numba's code calls and a process without numba does not have.

; An array that a function makes: a count of those who hold it, and behind it the numbers. Only the
; function itself and those that it calls hold it, so the count needs no atomic instructions.
%owner = type { i64, ptr, ptr, ptr, i64, ptr }

@tracewire_core_fault = weak_odr global i64 0

declare ptr @malloc(i64)
declare void @free(ptr)
declare double @frexp(double, ptr)
declare double @ldexp(double, i32)
declare double @nextafter(double, double)

define ptr @NRT_MemInfo_alloc(i64 %size) alwaysinline {
  %all = add i64 %size, 64
  %owner = call ptr @malloc(i64 %all)
  %none = icmp eq ptr %owner, null
  br i1 %none, label %end, label %fill
fill:
  store i64 1, ptr %owner
  %numbers = getelementptr i8, ptr %owner, i64 64
  %place = getelementptr %owner, ptr %owner, i32 0, i32 3
  store ptr %numbers, ptr %place
  br label %end
end:
  ret ptr %owner
}

define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) alwaysinline {
  %owner = call ptr @NRT_MemInfo_alloc(i64 %size)
  ret ptr %owner
}

define ptr @NRT_MemInfo_data_fast(ptr %owner) alwaysinline {
  %place = getelementptr %owner, ptr %owner, i32 0, i32 3
  %numbers = load ptr, ptr %place
  ret ptr %numbers
}

define void @NRT_incref(ptr %owner) alwaysinline {
  %none = icmp eq ptr %owner, null
  br i1 %none, label %end, label %more
more:
  %count = load i64, ptr %owner
  %next = add i64 %count, 1
  store i64 %next, ptr %owner
  br label %end
end:
  ret void
}

define void @NRT_decref(ptr %owner) alwaysinline {
  %none = icmp eq ptr %owner, null
  br i1 %none, label %end, label %less
less:
  %count = load i64, ptr %owner
  %next = sub i64 %count, 1
  store i64 %next, ptr %owner
  %last = icmp eq i64 %next, 0
  br i1 %last, label %free, label %end
free:
  call void @free(ptr %owner)
  br label %end
end:
  ret void
}

define double @numba_frexp(double %x, ptr %exponent) alwaysinline {
  %part = call double @frexp(double %x, ptr %exponent)
  ret double %part
}

define double @numba_ldexp(double %x, i32 %exponent) alwaysinline {
  %value = call double @ldexp(double %x, i32 %exponent)
  ret double %value
}

define double @numba_nextafter(double %x, double %towards) alwaysinline {
  %value = call double @nextafter(double %x, double %towards)
  ret double %value
}

define ptr @NRT_Allocate(i64 %size) alwaysinline {
  %place = call ptr @malloc(i64 %size)
  ret ptr %place
}

define void @NRT_Free(ptr %place) alwaysinline {
  call void @free(ptr %place)
  ret void
}

; An array without gaps as one row. numba asks for no other change of shape: there it gets an error.
define i32 @numba_attempt_nocopy_reshape(i64 %axes, ptr %shape, ptr %strides, i64 %new_axes, ptr %new_shape, ptr %new_strides, i64 %size, i32 %by_columns) alwaysinline {
  %row = icmp eq i64 %new_axes, 1
  br i1 %row, label %fill, label %end
fill:
  store i64 %size, ptr %new_strides
  br label %end
end:
  %done = zext i1 %row to i32
  ret i32 %done
}
